// Axis-aligned bounding boxes.
#pragma once

#include <optional>

#include "core/math/ray.h"

namespace mote::core {

struct Bounds3 {
    Vec3 lower{infinity, infinity, infinity};     ///< corner [m]
    Vec3 upper{-infinity, -infinity, -infinity};  ///< corner [m]

    /// Holds no point.
    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    void extend(const Vec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }  ///< to hold p
    /// To hold b.
    void extend(const Bounds3& b) { lower = glm::min(lower, b.lower), upper = glm::max(upper, b.upper); }
    Vec3 diagonal() const { return upper - lower; }              ///< from lower to upper [m]
    Vec3 center() const { return 0.5f * lower + 0.5f * upper; }  ///< of a box that is not empty [m]
    /// Radius of the sphere around center() that holds the box.
    float radius() const { return empty() ? 0.0f : 0.5f * glm::length(diagonal()); }
    /// Its border counts.
    bool contains(const Vec3& p) const {
        return glm::all(glm::greaterThanEqual(p, lower)) && glm::all(glm::lessThanEqual(p, upper));
    }
};

/// Where a ray from a point of the box leaves it.
inline float exit_distance(const Bounds3& box, const Ray& ray) {
    float exit = infinity;
    for (int axis = 0; axis < 3; ++axis) {
        const float d = ray.direction[axis], side = d < 0.0f ? box.lower[axis] : box.upper[axis];
        exit = std::fmin(exit, (side - ray.origin[axis]) / d);  // NaN along the side, which fmin passes over
    }
    return exit;
}

/// A part of a ray.
struct Interval {
    float t0, t1;  ///< its ends along the ray [m]
};

/// The part of the ray's (t_min, t_max) inside the box, or nothing. Directions with zero components are fine.
inline std::optional<Interval> intersect(const Bounds3& box, const Ray& ray) {
    float t0 = ray.t_min, t1 = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0.0f) {
            if (o < box.lower[axis] || o > box.upper[axis]) return std::nullopt;
            continue;
        }
        float near = (box.lower[axis] - o) / d, far = (box.upper[axis] - o) / d;
        if (near > far) std::swap(near, far);
        t0 = std::fmax(t0, near), t1 = std::fmin(t1, far);
    }
    if (!(t0 < t1)) return std::nullopt;
    return Interval{t0, t1};
}

}  // namespace mote::core
