// The transmittance along one ray to growing distances, from one walk.
//
// Estimates of neighbouring segments are independent, so their product is an unbiased estimate of the
// transmittance to every requested distance, and all of them together cost what one estimate to the farthest
// costs.
#pragma once

#include <span>

#include "core/geometry/shape.h"
#include "core/scene/medium.h"
#include "core/scene/medium_state.h"

namespace mote::core {

class TransmittanceAlong {
  public:
    /// `state` holds the media at ray.t_min; `boundaries` are the boundaries on the ray, sorted by distance
    /// (RayQueries::boundaries_along(), or WalkContext::boundary_hits after walk()). Keeps references to all
    /// but the state.
    TransmittanceAlong(const Ray& ray, const MediumState& state, std::span<const SurfaceHit> boundaries,
                       Rng& rng, TrackingCounters& counters)
        : ray_(ray), state_(state), boundaries_(boundaries), rng_(rng), counters_(counters), t_(ray.t_min) {}

    /// Estimate per channel of the transmittance from ray.t_min to `t`, which must not be nearer than before.
    Rgb advance_to(float t);
    /// The media at the last requested distance.
    const MediumState& state() const { return state_; }

  private:
    void pass(float t);

    const Ray& ray_;
    MediumState state_;
    std::span<const SurfaceHit> boundaries_;
    Rng& rng_;
    TrackingCounters& counters_;
    float t_;
    Rgb transmittance_{1.0f};
};

}  // namespace mote::core
