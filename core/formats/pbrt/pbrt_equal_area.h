// The equal-area mapping between the square and the sphere (Clarberg 2008, "Fast equal-area mapping of the
// (hemi)sphere using SIMD"): +z in the middle, -z in the corners.
#pragma once

#include <cmath>
#include <numbers>

#include "core/math/vec.h"

namespace mote::core {

/// The direction of a point of [0, 1]^2.
inline Vec3d equal_area_direction(const glm::dvec2& p) {
    const double u = 2.0 * p.x - 1.0, v = 2.0 * p.y - 1.0, a = std::fabs(u), b = std::fabs(v);
    const double distance = 1.0 - (a + b), r = 1.0 - std::fabs(distance);
    const double phi = (r == 0.0 ? 1.0 : (b - a) / r + 1.0) * std::numbers::pi / 4.0;
    const double s = r * std::sqrt(std::fmax(2.0 - r * r, 0.0));
    return {std::copysign(std::cos(phi) * s, u), std::copysign(std::sin(phi) * s, v),
            std::copysign(1.0 - r * r, distance)};
}

/// Its inverse, for a unit vector.
inline glm::dvec2 equal_area_square(const Vec3d& d) {
    const double x = std::fabs(d.x), y = std::fabs(d.y);
    const double r = std::sqrt(std::fmax(1.0 - std::fabs(d.z), 0.0));
    const double phi = x == 0.0 && y == 0.0 ? 0.0 : std::atan2(y, x) * 2.0 / std::numbers::pi;
    double v = phi * r, u = r - v;
    if (d.z < 0.0) {
        std::swap(u, v);
        u = 1.0 - u, v = 1.0 - v;
    }
    return {0.5 * (std::copysign(u, d.x) + 1.0), 0.5 * (std::copysign(v, d.y) + 1.0)};
}

}  // namespace mote::core
