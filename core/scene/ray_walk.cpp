#include "core/scene/ray_walk.h"

#include "core/scene/media_along.h"
#include "core/scene/scattering_points.h"

namespace mote::core {
namespace {

/// Tracks through one segment of one medium. Returns the distance of a real collision, if any.
std::optional<float> cross_segment(const MediumState& state, const Ray& ray, float t0, float t1,
                                   PathWeights& weights, Rgb& emitted, WalkContext& context) {
    const Medium* medium = state.current();
    if (!medium || !(t0 < t1)) return std::nullopt;
    Ray segment = ray;
    segment.t_min = t0, segment.t_max = t1;
    return medium->sample_collision(segment, weights, emitted, context.rng, context.tracking);
}

/// A path passes a pane by chance. Light that was sampled through it, with certainty, could have been
/// found this way with that chance: what `light` compares.
bool passes(const StraightPassage& pane, PathWeights& weights, Rng& rng) {
    if (!(rng.next_float() < pane.probability())) return false;
    weights.throughput *= pane.weight;
    weights.light /= pane.probability();
    return true;
}

WalkEvent reflected_at(const SurfaceHit& pane, float stop_chance, float surface_distance) {
    WalkEvent event;
    event.kind = WalkEvent::Kind::surface, event.hit = pane, event.distance = pane.t;
    event.surface_distance = surface_distance, event.reflected = true, event.stop_chance = stop_chance;
    return event;
}

/// As far along the ray as rounding can put a point onto the other side of what is hit there [m].
float margin_at(const SurfaceHit& hit, const Ray& ray) {
    const float cosine = std::fabs(glm::dot(hit.geometric_normal, ray.direction));
    return 4e-7f * (hit.t + max_component(glm::abs(hit.position))) / std::max(cosine, 1e-3f);
}

/// Surfaces at the ends of a segment, or null.
struct Ends {
    const SurfaceHit *before, *behind;
};

/// Distances between which a collision is kept. One so near to an end of the segment that its position, once
/// rounded, could be on the other side is moved off it: the path would continue in a medium that it is not
/// in, and never leave it.
struct KeptBetween {
    float first, last;
    KeptBetween(const Ends& ends, const Ray& ray)
        : first(ends.before ? ends.before->t + margin_at(*ends.before, ray) : ray.t_min),
          last(ends.behind ? ends.behind->t - margin_at(*ends.behind, ray) : infinity) {
        if (first > last) first = last = 0.5f * ((ends.before ? ends.before->t : ray.t_min) + ends.behind->t);
    }
};

WalkEvent collision_at(float t, const Medium* medium, float surface_distance) {
    WalkEvent event;
    event.kind = WalkEvent::Kind::collision, event.distance = t, event.medium = medium;
    event.surface_distance = surface_distance;
    return event;
}

/// `cross(t0, t1, Ends)` goes through a segment of one medium and returns the distance of a collision, if
/// any. `event` is the first surface on the ray, or none; what the path meets before takes its place.
/// `splits`: a segment may be crossed in two parts.
template <bool Media, bool splits, typename Cross>
void follow(const RayQueries& scene, const Ray& ray, MediumState& state, PathWeights& weights,
            WalkEvent& event, WalkContext& context, const Cross& cross) {
    const bool hit = event.kind == WalkEvent::Kind::surface;
    const float t_end = hit ? event.hit.t : ray.t_max;
    float t = ray.t_min;
    event.distance = hit ? t_end : infinity, event.surface_distance = t_end;
    if (!(Media ? scene.has_boundaries() : scene.has_panes())) {
        if constexpr (Media)
            if (const auto c = cross(t, t_end, Ends{nullptr, hit ? &event.hit : nullptr}))
                event = collision_at(*c, state.current(), t_end);
        return;
    }
    // In open space a path ends or collides as a rule, before it can meet a boundary.
    const Bounds3& open = scene.open_space();
    const float t_open = open.contains(ray.at(t)) ? exit_distance(open, ray) : t;
    const bool ends = t_end <= t_open;
    context.boundary_hits.clear();
    if (ends || (splits && !context.all_boundaries && t_open > t)) {
        if constexpr (Media)
            if (const auto c =
                    cross(t, ends ? t_end : t_open, Ends{nullptr, ends && hit ? &event.hit : nullptr})) {
                event = collision_at(*c, state.current(), t_end);
                return;
            }
        if (ends) return;
        t = t_open;
    }
    Ray boundary_ray = ray;
    boundary_ray.t_min = t, boundary_ray.t_max = t_end;
    ++context.rays.boundary;
    scene.boundaries_along(boundary_ray, context.boundary_hits);
    [[maybe_unused]] const SurfaceHit* before = nullptr;  // the boundary at t
    for (const SurfaceHit& boundary : context.boundary_hits) {
        if constexpr (Media)
            if (const auto c = cross(t, boundary.t, Ends{before, &boundary})) {
                event = collision_at(*c, state.current(), t_end);
                return;
            }
        if (is_pane(boundary))
            if (const StraightPassage pane = passage_through(boundary, ray.direction);
                !passes(pane, weights, context.rng)) {
                event = reflected_at(boundary, pane.stops, t_end);
                return;
            }
        if constexpr (Media) state.cross(*boundary.shape, boundary.geometric_normal, ray.direction);
        t = boundary.t, before = &boundary;
    }
    if constexpr (Media)
        if (const auto c = cross(t, t_end, Ends{before, hit ? &event.hit : nullptr}))
            event = collision_at(*c, state.current(), t_end);
}

/// The first surface on the ray, and nothing yet of what lies before it.
WalkEvent first_surface(const RayQueries& scene, const Ray& ray, WalkContext& context) {
    context.cancelled.check();
    ++context.rays.closest;
    WalkEvent event;
    if (const auto hit = scene.first_hit(ray)) event.kind = WalkEvent::Kind::surface, event.hit = *hit;
    return event;
}

}  // namespace

template <bool Media>
void walk_before(const RayQueries& scene, const Ray& ray, WalkEvent& event, MediumState& state,
                 PathWeights& weights, Rgb& emitted, WalkContext& context) {
    follow<Media, true>(scene, ray, state, weights, event, context,
                        [&](float t0, float t1, const Ends& ends) -> std::optional<float> {
                            const auto t = cross_segment(state, ray, t0, t1, weights, emitted, context);
                            if (!t) return std::nullopt;
                            const KeptBetween kept(ends, ray);
                            return std::clamp(*t, kept.first, kept.last);
                        });
}

template <bool Media>
WalkEvent walk(const RayQueries& scene, const Ray& ray, MediumState& state, PathWeights& weights,
               Rgb& emitted, WalkContext& context) {
    WalkEvent event = first_surface(scene, ray, context);
    walk_before<Media>(scene, ray, event, state, weights, emitted, context);
    return event;
}

void walk_to_surface_before(const RayQueries& scene, const Ray& ray, WalkEvent& event, MediumState& state,
                            PathWeights& weights, Rgb& emitted, ScatteringPoints& points,
                            WalkContext& context) {
    follow<true, false>(scene, ray, state, weights, event, context,
                        [&](float t0, float t1, const Ends& ends) -> std::optional<float> {
                            if (const Medium* medium = state.current(); medium && t0 < t1) {
                                const KeptBetween kept(ends, ray);
                                points.begin_part(state, kept.first, kept.last);
                                medium->scatter_along({ray.origin, ray.direction, t0, t1}, weights, emitted,
                                                      points, context.rng, context.tracking);
                            }
                            return std::nullopt;
                        });
}

WalkEvent walk_to_surface(const RayQueries& scene, const Ray& ray, MediumState& state, PathWeights& weights,
                          Rgb& emitted, ScatteringPoints& points, WalkContext& context) {
    WalkEvent event = first_surface(scene, ray, context);
    walk_to_surface_before(scene, ray, event, state, weights, emitted, points, context);
    return event;
}

template WalkEvent walk<true>(const RayQueries&, const Ray&, MediumState&, PathWeights&, Rgb&, WalkContext&);
template WalkEvent walk<false>(const RayQueries&, const Ray&, MediumState&, PathWeights&, Rgb&, WalkContext&);
template void walk_before<true>(const RayQueries&, const Ray&, WalkEvent&, MediumState&, PathWeights&, Rgb&,
                                WalkContext&);
template void walk_before<false>(const RayQueries&, const Ray&, WalkEvent&, MediumState&, PathWeights&, Rgb&,
                                 WalkContext&);

}  // namespace mote::core
