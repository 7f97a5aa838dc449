#include "lights/imperfect_shadow_maps/surface_samples.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/math/frame.h"
#include "core/math/warp.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::size_t batch = 4096, chunk = 64;  // lines
constexpr int max_surfaces = 64;                 // on one line
constexpr std::uint64_t stream = 0x737572666163ull;

void follow_line(const RayQueries& scene, const Vec3& centre, float radius, Rng rng,
                 std::vector<SurfaceSample>& points) {
    const Vec3 direction = square_to_sphere(rng.next_vec2());
    const Frame frame(direction);
    const Vec2 at = radius * square_to_disk(rng.next_vec2());
    Ray ray{centre - radius * direction + at.x * frame.s + at.y * frame.t, direction};
    for (int k = 0; k < max_surfaces; ++k) {
        const auto hit = scene.first_hit(ray);
        if (!hit) return;
        points.push_back({hit->position, hit->geometric_normal});
        ray.origin = offset_origin(*hit, direction), ray.t_min = 0.0f;
    }
}

}  // namespace

float SurfaceSamples::radius(std::size_t count, float coverage) const {
    if (points.empty() || count == 0) return 0.0f;
    const float of_these = density * float(count) / float(points.size());
    return std::sqrt(coverage / (pi * of_these));
}

SurfaceSamples sample_surfaces(const RayQueries& scene, std::size_t count, std::uint64_t seed) {
    SurfaceSamples result;
    const Bounds3 bounds = scene.bounds();
    const float radius = 1.001f * bounds.radius();
    if (!(radius > 0.0f) || !std::isfinite(radius)) return result;
    std::size_t lines = 0;
    std::vector<std::vector<SurfaceSample>> found(batch / chunk);
    while (result.points.size() < count && lines < std::max(64 * count, batch)) {
        tbb::parallel_for(std::size_t(0), found.size(), [&](std::size_t c) {
            found[c].clear();
            for (std::size_t i = 0; i < chunk; ++i)
                follow_line(scene, bounds.center(), radius,
                            Rng(hash_keys(seed, stream, lines + c * chunk + i)), found[c]);
        });
        for (const auto& part : found) result.points.insert(result.points.end(), part.begin(), part.end());
        lines += batch;
    }
    result.density = float(lines) / (2.0f * pi * radius * radius);
    Rng rng(hash_keys(seed, stream));
    auto& points = result.points;
    for (std::size_t i = points.size(); i > 1; --i)
        std::swap(points[i - 1], points[std::size_t(rng.next_u32()) % i]);
    if (points.size() > count) {
        result.density *= float(count) / float(points.size());
        points.resize(count);
    }
    return result;
}

}  // namespace mote::lights
