// The media along a ray: boundaries cut it into parts of one medium each; panes among them take light.
#pragma once

#include <optional>

#include "core/geometry/ray_tracer.h"
#include "core/materials/bsdf.h"
#include "core/scene/medium_state.h"

namespace mote::core {

/// What a ray meets where it crosses a pane.
inline StraightPassage passage_through(const SurfaceHit& pane, const Vec3& direction) {
    return pane.shape->bsdf->straight_passage({pane.uv}, pane.shading.to_local(-direction));
}
inline bool is_pane(const SurfaceHit& boundary) { return boundary.shape->bsdf->traits().pane; }

/// Calls part(t0, t1, state) for every part of the ray between boundaries, vacuum and parts of no length
/// among them, and pane(hit) for every pane between them, until one returns false. `state` holds the media at
/// ray.t_min. Returns the media at ray.t_max, nothing when it was stopped.
template <typename Part, typename Pane>
std::optional<MediumState> for_each_part(const RayTracer& rays, const Ray& ray, MediumState state,
                                         const Part& part, const Pane& pane) {
    float t = ray.t_min;
    bool goes_on = true;
    const auto cross = [&](const SurfaceHit& boundary) {
        goes_on = part(t, boundary.t, state) && (!is_pane(boundary) || pane(boundary));
        state.cross(*boundary.shape, boundary.geometric_normal, ray.direction);
        t = boundary.t;
        return goes_on;
    };
    if (rays.has_boundaries()) rays.for_each_hit(ray, RayTracer::Group::boundaries, cross);
    if (!goes_on || !part(t, ray.t_max, state)) return std::nullopt;
    return state;
}

}  // namespace mote::core
