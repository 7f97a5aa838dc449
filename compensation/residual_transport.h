// One step of the residual transport: from a receiver to a vertex whose light the bound takes away.
//
// Engelhardt 2013, Eq. 10.11, where the integral over z is one over directions w and distances t:
//   L_r(x <- y) = integral of  f*(x<-y<-z) B*(y,z) tau(y,z) C*(y->z) L(y <- z)  dt dw
// L is the light that z reflects or scatters, without what it emits: VPLs represent that alone. The integral
// runs over points in the medium, with sigma_s there, plus the surface at the end of the ray. A step
// estimates it with one vertex z, sampled with p(w) p(t); what is left to the caller is L at z. Since B* is 0
// beyond the bounding radius, rays are no longer than that.
#pragma once

#include <optional>
#include <vector>

#include "compensation/compensation_settings.h"
#include "core/scene/scattering_vertex.h"
#include "media/mean_extinction.h"

namespace mote::compensation {

/// A path that grows from a receiver, with everything before L in its weights.
struct ResidualPath {
    core::ScatteringVertex vertex;  ///< the receiver y; after a step the vertex z, whose wo points back to y
    core::MediumState state;        ///< media at the vertex, on the side of wo
    core::PathWeights weights;      ///< of the path so far, without the light that it finds
    /// Mean extinction around the vertex [1/m], where steps need it and a medium is near; found once,
    /// since many steps may start from one receiver.
    std::optional<core::Rgb> mean_extinction;
    bool mean_known = false;

    /// The weight of light that reaches or leaves the vertex: f is not in it.
    core::Rgb throughput() const { return weights.throughput / core::average(weights.unidirectional); }
};

/// The steps for one bound.
class ResidualTransport {
  public:
    /// Finds the mean extinction of every medium where the settings need it. `bound` is b [1/m^2], above 0.
    ResidualTransport(const core::RayQueries& scene, float bound, const CompensationSettings& settings);

    /// A path that starts at a receiver: y's own weights do not matter to the steps, so they are one number a
    /// channel. Samples the channel that drives distances.
    ResidualPath start(const core::ScatteringVertex& receiver, const core::MediumState& state,
                       const core::Rgb& throughput, core::Rng& rng) const;

    /// One step. Weights are multiplied by f* B* tau C* (and sigma_s) over the densities. Russian roulette by
    /// the fraction that is left. Returns false where nothing is to be compensated. Counts rays and tracking.
    template <bool Media>
    bool step(ResidualPath& path, core::WalkContext& context) const;

    float bound() const { return bound_; }    ///< b [1/m^2]
    float radius() const { return radius_; }  ///< of the bounding region between points in a medium [m]
    std::size_t memory_bytes() const;         ///< of what is known of the media

  private:
    /// The end of a ray of at most the bounding radius, found in one of two ways.
    template <bool Media>
    bool sample_by_free_path(ResidualPath& path, const core::Ray& ray, core::WalkContext& context) const;
    bool sample_in_mean_medium(ResidualPath& path, const core::Ray& ray, core::WalkContext& context) const;
    void find_mean_extinction(ResidualPath& path) const;
    bool by_free_path() const;
    bool may_hold(const core::Medium& medium, const core::Vec3& p) const;

    const core::RayQueries& scene_;
    CompensationSettings settings_;
    float bound_, radius_;
    struct LocalMedium {
        const core::Medium* medium;
        core::Bounds3 extent;
        media::MeanExtinction mean;
    };
    std::vector<LocalMedium> media_;  ///< empty where free paths are exact: nothing needs the mean
};

extern template bool ResidualTransport::step<true>(ResidualPath&, core::WalkContext&) const;
extern template bool ResidualTransport::step<false>(ResidualPath&, core::WalkContext&) const;

}  // namespace mote::compensation
