// The transmittance between two points: the boundaries on the way cut the ray into segments of one medium
// each.
#include "core/scene/media_along.h"
#include "core/scene/scene.h"

namespace mote::core {

/// Calls segment(medium, ray) for every part of the ray that lies in a medium, until it returns false.
/// Returns the medium at the end, null when it was not reached.
template <typename Segment>
const Medium* Scene::for_each_segment(const Ray& ray, MediumState state, const Segment& segment) const {
    std::vector<SurfaceHit> boundaries;  // takes memory only when one is met
    const auto part = [&](float t0, float t1, const MediumState& here) {
        const Medium* medium = here.current();
        return !medium || !(t0 < t1) || bool(segment(*medium, Ray{ray.origin, ray.direction, t0, t1}));
    };
    const auto end = for_each_part(*this, ray, state, boundaries, part);
    return end ? end->current() : nullptr;
}

Rgb Scene::transmittance(const Vec3& from, const Vec3& to, const MediumState& state, Rng& rng,
                         TrackingCounters& counters) const {
    Rgb result(1.0f);
    if (!has_media()) return result;
    const Vec3 d = to - from;
    const float distance = glm::length(d);
    if (!(distance > 0.0f)) return result;
    for_each_segment(Ray{from, d / distance, 0.0f, distance}, state, [&](const Medium& m, const Ray& r) {
        result *= m.transmittance(r, rng, counters);
        return !is_black(result);
    });
    return result;
}

const Medium* Scene::connect(const Ray& ray, const MediumState& state, PathWeights& weights, Rng& rng,
                             TrackingCounters& counters) const {
    if (!has_media()) return nullptr;
    return for_each_segment(ray, state, [&](const Medium& m, const Ray& r) {
        m.connect(r, weights, rng, counters);
        return !is_black(weights.throughput);
    });
}

}  // namespace mote::core
