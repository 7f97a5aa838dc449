// Marching through media, and scattering along a ray, for media without better methods.
#include "core/scene/medium.h"

#include <cmath>

#include "core/scene/scattering_points.h"

namespace mote::core {

namespace {

/// Midpoint rule over [t0, t1] in equal steps of at most `step`; one step where that is infinite.
Vec3d march(const Medium& medium, const Ray& ray, double t0, double t1, float step,
            TrackingCounters& counters) {
    const double length = t1 - t0;
    if (!(length > 0.0)) return Vec3d(0.0);
    const bool one = !std::isfinite(step) || !std::isfinite(length);
    const double count = one ? 1.0 : std::max(std::ceil(length / double(step)), 1.0), h = length / count;
    Vec3d sum(0.0);
    for (double i = 0.0; i < count; i += 1.0) {
        const double t = std::isfinite(length) ? t0 + (i + 0.5) * h : t0;
        sum += Vec3d(medium.coefficients(ray.at(float(t))).sigma_t);
    }
    if (!one) counters.lookups += std::uint64_t(count);
    for (int c = 0; c < 3; ++c)
        if (sum[c] > 0.0) sum[c] *= h;  // vacuum of infinite length is 0, not NaN
    return sum;
}

}  // namespace

void Medium::scatter_along(const Ray& ray, PathWeights& weights, Rgb& emitted, ScatteringPoints& points,
                           Rng& rng, TrackingCounters& counters) const {
    const int tries = std::max(points.count(), 1);
    for (int i = 0; i < tries; ++i) {
        PathWeights path = weights;
        path.throughput /= float(tries);
        path.hero = std::min(int(rng.next_float() * 3.0f), 2);  // of this point alone
        if (const auto t = sample_collision(ray, path, emitted, rng, counters))
            points.add(ray.at(*t), path.throughput / average(path.unidirectional));
    }
    weights.throughput *= transmittance(ray, rng, counters);
}

float Medium::marching_step(float voxels, float length) const {
    const MediumTraits t = traits();
    if (t.homogeneous) return infinity;
    return std::isfinite(t.voxel_size) ? voxels * t.voxel_size : length / float(default_steps);
}

Vec3d Medium::optical_depth_along(const Ray& ray, float voxels, TrackingCounters& counters) const {
    const auto part = intersect(bounds(), ray);
    if (!part) return Vec3d(0.0);
    return march(*this, ray, part->t0, part->t1, marching_step(voxels, part->t1 - part->t0), counters);
}

void Medium::optical_depths_along(const Ray& ray, float voxels, std::span<Vec3d> depths,
                                  TrackingCounters& counters) const {
    const auto part = intersect(bounds(), ray).value_or(Interval{0.0f, 0.0f});
    const float step = marching_step(voxels, part.t1 - part.t0);
    const double t0 = ray.t_min, length = (double(ray.t_max) - t0) / double(depths.size());
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double begin = std::max(t0 + double(i) * length, double(part.t0));
        const double end = std::min(t0 + double(i + 1) * length, double(part.t1));
        depths[i] = sum += march(*this, ray, begin, end, step, counters);
    }
}

}  // namespace mote::core
