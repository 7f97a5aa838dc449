// The guide of a learned field: incident radiance at the vertex, times a lobe of the cosine or of the phase
// function (Herholz et al. 2019), in closed form.
#pragma once

#include "lights/guiding/guiding_field.h"
#include "lights/guiding/scattering_guide.h"

namespace mote::lights {

/// Guide of what arrives on surfaces, and in media.
class LearnedGuide final : public ScatteringGuide {
  public:
    /// Throws OutOfMemory where the fields do not fit.
    LearnedGuide(const GuidingField::Settings& settings, bool media, const core::MemoryBudget& memory);

    /// Sets `lobes` to the product at the vertex.
    void find(const core::ScatteringVertex& vertex, VmfMixture& lobes) const override;
    /// True where the vertex takes directions of a guide: it has no delta part, and light stays on its side.
    static bool guides(const core::ScatteringVertex& vertex);

    GuidingField& surfaces() { return surfaces_; }              ///< what arrives on surfaces
    GuidingField& media() { return media_; }                    ///< what arrives in media
    const GuidingField& surfaces() const { return surfaces_; }  ///< see above
    const GuidingField& media() const { return media_; }        ///< see above

  private:
    GuidingField surfaces_, media_;
};

}  // namespace mote::lights
