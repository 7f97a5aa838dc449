// Guides of paths.
//
// Directions of a path at its scattering vertices are those of the BSDF or phase function, and those that a
// guide adds to them, mixed by a probability (one-sample multiple importance sampling; Vorba et al. 2014). A
// guide may also expect radiance at vertices: then it chooses them (choose_scattering.h).
//
// The mixture's density replaces that of the BSDF or phase function wherever it counts: in the weight of the
// path, and against next-event estimation. A path therefore stays unbiased whatever the guide has learned.
#pragma once

#include "core/scene/scattering_vertex.h"
#include "lights/guiding/reflected_radiance.h"
#include "lights/guiding/vmf_mixture.h"

namespace mote::lights {

/// Source of further directions at vertices, and of vertices.
class ScatteringGuide {
  public:
    virtual ~ScatteringGuide() = default;
    /// Sets `lobes` to the directions for a vertex, or leaves them empty where it scatters by itself alone.
    virtual void find(const core::ScatteringVertex& vertex, VmfMixture& lobes) const = 0;
    /// True where it guides nothing anywhere.
    virtual bool none() const { return false; }
    /// Number of candidates that a homogeneous medium leaves on a segment for the choice of the next vertex;
    /// grids leave up to four times as many (core::ScatteringPoints). 0: distances by extinction. Not in
    /// scenes with media that glow.
    virtual int candidates() const { return 0; }
    /// Radiance expected behind a vertex.
    virtual ExpectedRadiance expected(const core::Vec3& /*position*/, bool /*on_surface*/) const {
        return {};
    }
};

/// Adds none.
const ScatteringGuide& no_guide();

/// Density of a direction [1/sr] whose density by the vertex alone is `own_pdf`. `factor`: densities count
/// times this (DirectSample::line_density).
inline float guided_pdf(const VmfMixture& lobes, const core::Vec3& wi, float own_pdf, float factor = 1.0f) {
    if (lobes.empty) return own_pdf;
    return (1.0f - lobes.probability) * own_pdf + lobes.probability * factor * lobes.pdf_solid_angle(wi);
}

/// False where a guide has changed the weight of a path so much that the path is to continue without it:
/// factors of many vertices multiply, and what they multiply to would have no bound. `ratio`: density of the
/// path's choices over that without a guide.
inline bool within_guided_window(float ratio) { return ratio > 0.25f && ratio < 64.0f; }

/// Bound of GuidedSample::pdf_ratio, where a direction of the guide is hardly one of the vertex.
inline constexpr float max_pdf_ratio = 1e6f;

/// A direction that a vertex and its guide chose.
struct GuidedSample {
    core::ScatterSample scattering;  ///< its weight and density are those of both together
    /// Density of the direction over its density by the vertex alone; at most max_pdf_ratio.
    float pdf_ratio = 1.0f;
};
/// ScatteringVertex::sample() with the guide's lobes; nothing where the path ends.
std::optional<GuidedSample> sample_guided(const core::ScatteringVertex& vertex, const VmfMixture& lobes,
                                          float u_lobe, const core::Vec2& u, core::TransportMode mode);

}  // namespace mote::lights
