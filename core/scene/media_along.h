// The media along a ray: boundaries cut it into parts of one medium each.
#pragma once

#include <optional>
#include <vector>

#include "core/scene/ray_queries.h"

namespace mote::core {

/// Calls part(t0, t1, state) for every part of the ray between boundaries, vacuum and parts of no length
/// among them, until it returns false. `state` holds the media at ray.t_min; `boundaries` is memory to reuse,
/// and holds what was met. Returns the media at ray.t_max, nothing when it was stopped.
template <typename Part>
std::optional<MediumState> for_each_part(const RayQueries& scene, const Ray& ray, MediumState state,
                                         std::vector<SurfaceHit>& boundaries, const Part& part) {
    float t = ray.t_min;
    if (scene.has_boundaries()) {
        scene.boundaries_along(ray, boundaries);
        for (const SurfaceHit& boundary : boundaries) {
            if (!part(t, boundary.t, state)) return std::nullopt;
            state.cross(*boundary.shape, boundary.geometric_normal, ray.direction);
            t = boundary.t;
        }
    }
    if (!part(t, ray.t_max, state)) return std::nullopt;
    return state;
}

}  // namespace mote::core
