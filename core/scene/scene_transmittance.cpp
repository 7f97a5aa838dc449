// The transmittance between two points: the boundaries on the way cut the ray into segments of one medium
// each.
#include "core/scene/media_along.h"
#include "core/scene/scene.h"

namespace mote::core {

/// Calls segment(medium, ray) for every part of the ray that lies in a medium, and pane(passage) at every
/// pane, until one returns false. Returns the medium at the end, null when it was not reached.
template <typename Segment, typename Pane>
const Medium* Scene::for_each_segment(const Ray& ray, const MediumState& state, const Segment& segment,
                                      const Pane& pane) const {
    const auto part = [&](float t0, float t1, const MediumState& here) {
        const Medium* medium = here.current();
        return !medium || !(t0 < t1) || bool(segment(*medium, Ray{ray.origin, ray.direction, t0, t1}));
    };
    const auto end = for_each_part(*this, ray, state, part, [&](const SurfaceHit& hit) {
        return bool(pane(passage_through(hit, ray.direction)));
    });
    return end ? end->current() : nullptr;
}

Rgb Scene::transmittance(const Vec3& from, const Vec3& to, const MediumState& state, Rng& rng,
                         TrackingCounters& counters) const {
    Rgb result(1.0f);
    if (!attenuates()) return result;
    const Vec3 d = to - from;
    const float distance = glm::length(d);
    if (!(distance > 0.0f)) return result;
    const auto medium = [&](const Medium& m, const Ray& r) {
        result *= m.transmittance(r, rng, counters);
        return !is_black(result);
    };
    const auto pane = [&](const StraightPassage& p) {
        result *= p.transmittance();
        return !is_black(result);
    };
    for_each_segment(Ray{from, d / distance, 0.0f, distance}, state, medium, pane);
    return result;
}

const Medium* Scene::connect(const Ray& ray, const MediumState& state, PathWeights& weights, Rng& rng,
                             TrackingCounters& counters) const {
    if (!attenuates()) return nullptr;
    const auto medium = [&](const Medium& m, const Ray& r) {
        m.connect(r, weights, rng, counters);
        return !is_black(weights.throughput);
    };
    const auto pane = [&](const StraightPassage& p) { return connect_through(p, weights); };
    return for_each_segment(ray, state, medium, pane);
}

}  // namespace mote::core
