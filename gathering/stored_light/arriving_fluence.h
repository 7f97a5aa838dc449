// Light that arrives at the points of media directly from lights.
#pragma once

#include "core/geometry/ray_counters.h"
#include "core/scene/lit_scene.h"
#include "gathering/volume_points/volume_light.h"

namespace mote::gathering {

/// By point, and what it took.
struct ArrivedFluence {
    std::vector<Fluence> fluence;
    core::RayCounters rays;
    core::TrackingCounters tracking;
};

/// `samples` lights are drawn for every point, and as many directions, weighed against each other as at the
/// vertices of eye paths. Numbers are keyed by `key` and the point. Without bias; the same for any number of
/// threads; throws core::Cancelled.
ArrivedFluence direct_fluence_at(const core::LitScene& scene, const VolumePoints& points, int samples,
                                 std::uint64_t key, core::CancelToken cancelled);

}  // namespace mote::gathering
