// Follows a ray through null boundaries, panes and media to its next real event: a surface, a collision, or
// the outside. A pane that lets the path pass is no event; one that reflects it is.
//
// Everything that traces paths (path tracers, light particles, eye paths of many-light methods) advances by
// this one function, so that all of them agree on which medium lies where. Without media it is one
// closest-hit query.
#pragma once

#include <algorithm>
#include <vector>

#include "core/geometry/ray_counters.h"
#include "core/objects/cancellation.h"
#include "core/scene/ray_queries.h"

namespace mote::core {

/// Generator, counters and scratch memory of one task; made once a tile, never shared between threads.
struct WalkContext {
    Rng rng;
    RayCounters rays;
    TrackingCounters tracking;
    std::vector<SurfaceHit> boundary_hits;  ///< up to the first surface on the last ray; reused between rays
    bool all_boundaries = true;  ///< false: boundary_hits may leave out those behind a collision, unseen
    CancelToken cancelled;       ///< walk() tests it, and throws
};

/// The channel that drives the distances of a path, sampled once a path (PathWeights::hero).
inline int sample_hero(Rng& rng) { return std::min(int(rng.next_float() * 3.0f), 2); }

struct WalkEvent {
    enum class Kind : std::uint8_t { escaped, surface, collision };
    Kind kind = Kind::escaped;
    float distance = infinity;          ///< along the ray [m]
    float surface_distance = infinity;  ///< of the first surface on the ray, reached or not; else t_max.
                                        ///< Panes are passed
    SurfaceHit hit;                     ///< surface only
    bool reflected = false;             ///< by the pane `hit`, which the path did not pass
    float stop_chance = 1.0f;           ///< of that pane: StraightPassage::stops; 1 for all else
    const Medium* medium = nullptr;     ///< collision only
};

/// Throws Cancelled when the context is cancelled. Advances along `ray` and updates `state` (media at the
/// end), `weights` (see Medium::sample_collision) and `emitted` (emission of media met on the way). `Media` =
/// false compiles the media away: state and emitted are left alone, weights where there are no panes.
template <bool Media>
WalkEvent walk(const RayQueries& scene, const Ray& ray, MediumState& state, PathWeights& weights,
               Rgb& emitted, WalkContext& context);

/// walk() once the first surface on the ray is known: `event` is that (kind and hit), or escaped, and becomes
/// the event that the path meets. Throws nothing.
template <bool Media>
void walk_before(const RayQueries& scene, const Ray& ray, WalkEvent& event, MediumState& state,
                 PathWeights& weights, Rgb& emitted, WalkContext& context);

/// Continues to the first surface, or to a pane that reflects the path, or outside: media on the way scatter
/// at `points` and let the rest through (Medium::scatter_along). For paths whose `weights.light` is black.
WalkEvent walk_to_surface(const RayQueries& scene, const Ray& ray, MediumState& state, PathWeights& weights,
                          Rgb& emitted, ScatteringPoints& points, WalkContext& context);
/// Once the first surface on the ray is known, as in walk_before().
void walk_to_surface_before(const RayQueries& scene, const Ray& ray, WalkEvent& event, MediumState& state,
                            PathWeights& weights, Rgb& emitted, ScatteringPoints& points,
                            WalkContext& context);

extern template WalkEvent walk<true>(const RayQueries&, const Ray&, MediumState&, PathWeights&, Rgb&,
                                     WalkContext&);
extern template WalkEvent walk<false>(const RayQueries&, const Ray&, MediumState&, PathWeights&, Rgb&,
                                      WalkContext&);

extern template void walk_before<true>(const RayQueries&, const Ray&, WalkEvent&, MediumState&, PathWeights&,
                                       Rgb&, WalkContext&);
extern template void walk_before<false>(const RayQueries&, const Ray&, WalkEvent&, MediumState&, PathWeights&,
                                        Rgb&, WalkContext&);

}  // namespace mote::core
