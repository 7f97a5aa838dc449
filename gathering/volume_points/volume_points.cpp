#include "gathering/volume_points/volume_points.h"

#include <algorithm>
#include <cmath>

#include "core/math/random.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Balls of neighbours overlap by this: of the radius of a ball of the point's volume.
constexpr float spread = 1.0f;
constexpr double largest_over_mean = 3.0;

double ball_radius(double volume) { return std::cbrt(3.0 * volume / (4.0 * double(pi))); }

double mean_radius(const VolumePoints& points) {
    double sum = 0.0;
    for (const float v : points.volumes) sum += double(v);
    return points.size() > 0 ? ball_radius(sum / double(points.size())) : 0.0;
}

/// As a hierarchy of surface points has them.
Surfels as_surfels(const VolumePoints& points) {
    Surfels surfels;
    surfels.positions = points.positions;
    surfels.normals.assign(points.size(), Vec3(0.0f, 0.0f, 1.0f));
    surfels.radius = spread * float(mean_radius(points));
    return surfels;
}

}  // namespace

VolumePoints draw_volume_points(const MediumSamples& samples, std::uint32_t count, std::uint64_t key) {
    VolumePoints points;
    double all = 0.0;
    for (const ScatteringPlace& place : samples.places) all += double(average(place.sigma_s));
    if (!(all > 0.0) || count == 0) return points;
    // Steps of `step` from a random start: place i is met weight / step times in the mean.
    const double step = all / double(count);
    double next = step * double(Rng(hash_keys(key, 0x766f6cull)).next_float()), passed = 0.0;
    for (const ScatteringPlace& place : samples.places) {
        const double weight = double(average(place.sigma_s));
        passed += weight;
        int drawn = 0;
        for (; next < passed; next += step) ++drawn;
        if (drawn == 0) continue;
        points.positions.push_back(place.position);
        points.volumes.push_back(float(samples.cell_volume * double(drawn) * step / weight));
        points.sigma_s.push_back(place.sigma_s);
        points.states.push_back(place.state);
    }
    return points;
}

VolumeHierarchy::VolumeHierarchy(const VolumePoints& points) : tree_(as_surfels(points)) {
    const double largest = largest_over_mean * mean_radius(points);
    radii_.reserve(points.size());
    for (const std::uint32_t point : tree_.order())
        radii_.push_back(spread * float(std::min(ball_radius(double(points.volumes[point])), largest)));
}

}  // namespace mote::gathering
