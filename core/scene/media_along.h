// The media along a ray: boundaries cut it into parts of one medium each; panes among them take light.
#pragma once

#include <optional>

#include "core/geometry/bsdf_point.h"
#include "core/scene/ray_queries.h"

namespace mote::core {

/// Event where a ray crosses a pane.
inline StraightPassage passage_through(const SurfaceHit& pane, const Vec3& direction) {
    return pane.shape->bsdf->straight_passage(bsdf_point(pane), pane.shading.to_local(-direction));
}
inline bool is_pane(const SurfaceHit& boundary) {
    return boundary.shape->bsdf && boundary.shape->bsdf->traits().pane;
}

/// A path that goes this way passes the pane by chance (ray_walk.cpp), a connection always. Returns false
/// where nothing passes.
inline bool connect_through(const StraightPassage& pane, PathWeights& weights) {
    weights.throughput *= pane.transmittance();
    weights.unidirectional *= pane.probability();
    return !is_black(weights.throughput);
}
/// False for segments within the scene's open space.
inline bool may_meet_boundaries(const RayQueries& scene, const Ray& ray) {
    if (!scene.has_boundaries()) return false;
    const Bounds3& open = scene.open_space();
    return !open.contains(ray.at(ray.t_min)) || !(ray.t_max <= exit_distance(open, ray));
}
/// RayQueries::connect() for methods that do not see media: panes alone.
inline void connect_through_panes(const RayQueries& scene, const Ray& ray, PathWeights& weights) {
    if (!scene.has_panes()) return;
    scene.for_each_boundary(ray, [&](const SurfaceHit& hit) {
        return !is_pane(hit) || connect_through(passage_through(hit, ray.direction), weights);
    });
}

/// Calls part(t0, t1, state) for every part of the ray between boundaries, vacuum and parts of no length
/// among them, and pane(hit) for every pane between them, until one returns false. `state` holds the media at
/// ray.t_min. Returns the media at ray.t_max, nothing when it was stopped.
template <typename Part, typename Pane>
std::optional<MediumState> for_each_part(const RayQueries& scene, const Ray& ray, MediumState state,
                                         const Part& part, const Pane& pane) {
    float t = ray.t_min;
    bool continues = true;
    const auto cross = [&](const SurfaceHit& boundary) {
        continues = part(t, boundary.t, state) && (!is_pane(boundary) || pane(boundary));
        state.cross(*boundary.shape, boundary.geometric_normal, ray.direction);
        t = boundary.t;
        return continues;
    };
    if (may_meet_boundaries(scene, ray)) scene.for_each_boundary(ray, cross);
    if (!continues || !part(t, ray.t_max, state)) return std::nullopt;
    return state;
}

}  // namespace mote::core
