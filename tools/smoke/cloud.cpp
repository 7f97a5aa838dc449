#include "tools/smoke/cloud.h"

#include <algorithm>

#include "core/math/random.h"
#include "tools/smoke/noise.h"

namespace mote::tools {

using core::Vec3;

namespace {

struct Ball {
    Vec3 centre;
    float radius;
};

/// Balls in a box of height 1 that is as wide as `aspect`: large ones low, smaller ones on their tops.
std::vector<Ball> heap_balls(const Vec3& aspect, std::uint64_t seed) {
    core::Rng rng(core::hash_keys(seed, 0x636c6f7564ull));
    const Vec3 middle(0.5f * aspect.x, 0.0f, 0.5f * aspect.z);
    std::vector<Ball> balls;
    for (int i = 0; i < 34; ++i) {
        const float angle = 2.0f * core::pi * rng.next_float();
        const float reach = std::sqrt(rng.next_float());
        const Vec3 out(std::cos(angle) * aspect.x, 0.0f, std::sin(angle) * aspect.z);
        const float radius = core::lerp(0.24f, 0.11f, reach) * (0.8f + 0.4f * rng.next_float());
        // The heap is highest in the middle; nothing may stand beyond the box.
        const float height = core::lerp(0.52f, 0.10f, reach) * (0.35f + 0.65f * rng.next_float());
        balls.push_back({middle + out * (0.32f * reach) + Vec3(0.0f, 0.2f + height, 0.0f), radius});
    }
    return balls;
}

/// Distance to the union of the balls, negative inside, with rounded seams (polynomial smooth minimum).
float distance_to(const std::vector<Ball>& balls, const Vec3& p) {
    constexpr float seam = 0.05f;
    float d = 1e9f;
    for (const Ball& ball : balls) {
        const float next = glm::length(p - ball.centre) - ball.radius;
        const float h = std::fmax(seam - std::fabs(d - next), 0.0f) / seam;
        d = std::fmin(d, next) - 0.25f * seam * h * h;
    }
    return d;
}

float smooth_step(float lower, float upper, float x) {
    const float t = glm::clamp((x - lower) / (upper - lower), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

}  // namespace

std::vector<float> make_cloud(const CloudSettings& settings) {
    const GridSize& size = settings.size;
    const float height = float(size.y);
    const Vec3 aspect(float(size.x) / height, 1.0f, float(size.z) / height);
    const std::vector<Ball> balls = heap_balls(aspect, settings.seed);
    const Noise noise(settings.seed);
    std::vector<float> density(size.cells(), 0.0f);
    for_each_row(size, [&](int j, int k) {
        for (int i = 0; i < size.x; ++i) {
            const Vec3 p = Vec3(float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f) / height;
            const float d = distance_to(balls, p);
            if (d > 0.12f) continue;  // farther out than any bulge reaches
            const Vec3 warp = 0.03f * noise.vector_at(p * 5.0f);
            const float bulges = noise.billow((p + warp) * 5.5f, 5, 0.55f);
            const float base = smooth_step(0.12f, 0.22f, p.y + 0.05f * noise.fractal(p * 6.0f, 3));
            const float inside = smooth_step(-0.02f, 0.03f, 0.34f * bulges - 0.03f - d);
            density[size.index(i, j, k)] = inside * base;
        }
    });
    return density;
}

}  // namespace mote::tools
