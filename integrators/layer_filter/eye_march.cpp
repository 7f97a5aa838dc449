#include "integrators/layer_filter/eye_march.h"

#include <algorithm>
#include <cmath>

namespace mote::integrators {

using namespace core;

namespace {

constexpr int max_steps = 65536;
/// Steps through a homogeneous medium; they are exact, and S is linear between them.
constexpr int even_steps = 32;

int steps_of(const Medium& medium, const Ray& part, float voxels) {
    const float length = part.t_max - part.t_min;
    const float step = medium.marching_step(voxels, length);
    if (!std::isfinite(length)) return 1;
    if (!std::isfinite(step)) return even_steps;
    return int(std::clamp(std::ceil(length / step), 1.0f, float(max_steps)));
}

Rgb ratio(const Rgb& a, const Rgb& b) {
    return {b.x > 0.0f ? a.x / b.x : 0.0f, b.y > 0.0f ? a.y / b.y : 0.0f, b.z > 0.0f ? a.z / b.z : 0.0f};
}

/// Where the i-th of n parts of a ray has its middle; where it begins if it never ends.
Vec3 middle(const Ray& ray, int i, int n) {
    if (!std::isfinite(ray.t_max)) return ray.at(ray.t_min);
    return ray.at(ray.t_min + (ray.t_max - ray.t_min) * ((float(i) + 0.5f) / float(n)));
}

}  // namespace

void EyeMarch::march(const Scene& scene, const Ray& ray, float last, float voxels, WalkContext& walk) {
    knots_.clear();
    knots_.push_back({ray.t_min, {}});
    screenspace::find_segments(scene, ray, scene.eye_medium_state(ray), segments_, walk);
    for (const auto& s : segments_) {
        if (!s.medium) continue;
        const float split = std::clamp(last, s.t0, s.t1);  // an endless part has no steps: it is one
        add_part(*s.medium, {ray.origin, ray.direction, s.t0, split}, voxels, walk);
        add_part(*s.medium, {ray.origin, ray.direction, split, s.t1}, voxels, walk);
    }
}

void EyeMarch::add_part(const Medium& medium, const Ray& part, float voxels, WalkContext& walk) {
    if (!(part.t_min < part.t_max)) return;
    Value value = knots_.back().value;
    knots_.push_back({part.t_min, value});
    const int n = steps_of(medium, part, voxels);
    depths_.assign(std::size_t(n), Vec3d(0.0));
    if (n > 1)
        medium.optical_depths_along(part, voxels, depths_, walk.tracking);
    else
        depths_[0] = medium.optical_depth_along(part, voxels, walk.tracking);
    Vec3d before(0.0);
    for (int i = 0; i < n; ++i) {
        const Rgb passes = exp_minus(Rgb(depths_[std::size_t(i)] - before));
        before = depths_[std::size_t(i)];
        const MediumCoefficients c = medium.coefficients(middle(part, i, n));
        value.scattering += value.transmittance * (1.0f - passes) * ratio(c.sigma_s, c.sigma_t);
        value.transmittance *= passes;
        const float share = float(i + 1) / float(n);
        knots_.push_back({i + 1 == n ? part.t_max : part.t_min + (part.t_max - part.t_min) * share, value});
    }
}

EyeMarch::Value EyeMarch::at(float t) const {
    const auto next = std::upper_bound(knots_.begin(), knots_.end(), t,
                                       [](float at, const Knot& knot) { return at < knot.t; });
    if (next == knots_.begin()) return {};
    const Knot& a = *(next - 1);
    if (next == knots_.end() || !std::isfinite(next->t)) return a.value;
    const float u = (t - a.t) / (next->t - a.t);
    return {a.value.transmittance + u * (next->value.transmittance - a.value.transmittance),
            a.value.scattering + u * (next->value.scattering - a.value.scattering)};
}

}  // namespace mote::integrators
