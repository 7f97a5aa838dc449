// The guide of learned fields. Directions: incident radiance at the vertex, times a lobe of the cosine or of
// the phase function (Herholz et al. 2019), in closed form. Vertices: the radiance that is reflected there.
#pragma once

#include "lights/guiding/guiding_field.h"
#include "lights/guiding/scattering_guide.h"

namespace mote::lights {

/// Decisions of paths that a guide makes.
enum class GuideParts : std::uint8_t {
    directions,              ///< at their vertices
    directions_and_vertices  ///< and where they scatter in media, and which of them end
};

/// Samples of training paths.
struct GuidingSamples {
    std::vector<GuidingSample> surfaces, media;          ///< incident radiance
    std::vector<ReflectedSample> reflected_by_surfaces;  ///< radiance that surfaces reflect
    std::vector<ReflectedSample> reflected_by_media;     ///< radiance that media scatter
    void append(const GuidingSamples& other);            ///< behind these
};

/// Guide of what arrives on surfaces and in media, and of what is reflected there.
class LearnedGuide final : public ScatteringGuide {
  public:
    /// `largest`: all that it will ever decide. Throws OutOfMemory where the fields do not fit.
    LearnedGuide(const GuidingField::Settings& settings, bool media, GuideParts largest,
                 const core::MemoryBudget& memory);

    /// Learns from a batch, in its order; it is sorted.
    void add(GuidingSamples& samples);
    /// All that was learned so far counts this much.
    void scale(double factor);
    /// From now on; `largest` at first. Vertices of scenes without media are not chosen.
    void decide(GuideParts parts) { parts_ = parts; }

    /// Sets `lobes` to the product at the vertex.
    void find(const core::ScatteringVertex& vertex, VmfMixture& lobes) const override;
    int candidates() const override { return chooses() ? candidates_of_a_segment : 0; }
    ExpectedRadiance expected(const core::Vec3& position, bool on_surface) const override;
    /// True where the vertex takes directions of a guide: it has no delta part, and light stays on its side.
    static bool guides(const core::ScatteringVertex& vertex);

    const GuidingField& surfaces() const { return surfaces_; }  ///< what arrives on surfaces
    const GuidingField& media() const { return media_; }        ///< what arrives in media
    std::size_t leaves() const;                                 ///< of all fields

    static constexpr int candidates_of_a_segment = 1;  ///< candidates(), where vertices are chosen

  private:
    bool chooses() const { return parts_ == GuideParts::directions_and_vertices; }

    GuidingField surfaces_, media_;
    ReflectedField reflected_by_surfaces_, reflected_by_media_;
    GuideParts parts_;
};

}  // namespace mote::lights
