// Guides of paths.
//
// Directions of a path at its scattering vertices are those of the BSDF or phase function, and those that a
// guide adds to them, mixed by a fixed probability (one-sample multiple importance sampling; Vorba et al.
// 2014). A guide may also expect radiance at vertices: then it chooses them (choose_scattering.h), and ends
// paths.
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

/// Probability that a guide chooses the direction, where it has lobes. Less than half: what the lobes lack is
/// found too seldom else, vertex after vertex, by rare bright paths.
inline constexpr float guide_probability = 0.35f;

/// A path whose directions the guide chose so much more seldom than the vertices is guided no further: each
/// vertex may raise its weight to 1.5 times that of an unguided one, and long paths would become fireflies.
inline constexpr float min_guide_ratio = 0.25f;

/// Bound of GuidedSample::pdf_ratio, where a direction of the guide is hardly one of the vertex.
inline constexpr float max_pdf_ratio = 1e6f;

/// Density of a direction [1/sr] whose density by the vertex alone is `own_pdf`. `factor`: densities count
/// times this (DirectSample::line_density).
inline float guided_pdf(const VmfMixture& lobes, const core::Vec3& wi, float own_pdf, float factor = 1.0f) {
    if (lobes.empty) return own_pdf;
    return (1.0f - guide_probability) * own_pdf + guide_probability * factor * lobes.pdf_solid_angle(wi);
}

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
