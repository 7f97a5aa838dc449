// Bounds on the rounding of points on surfaces, and the rounding of origins away from them.
//
// Points are computed in double precision and rounded once. What remains is that rounding, and the error that
// Embree's single-precision triangle test makes when it decides on which side of the triangle a ray starts.
#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace mote::core {

/// Half a unit in the last place of 1: the relative error of one rounding to single precision.
inline constexpr double half_ulp = 0x1p-24;

/// Upper bound of how far rounding p to single precision moves it along the unit normal n [m].
inline float quantization_error(const Vec3& p, const Vec3& n) {
    const double sum = std::fabs(double(p.x) * double(n.x)) + std::fabs(double(p.y) * double(n.y)) +
                       std::fabs(double(p.z) * double(n.z));
    return float(sum * half_ulp * 1.0001);
}

/// The float nearest to `exact` that lies at least as far from `start` as exact does. It differs from `start`
/// unless exact == start.
inline float round_away(double exact, float start) {
    const auto rounded = float(exact);
    if (exact > double(start) && (double(rounded) < exact || rounded == start))
        return std::nextafter(rounded, infinity);
    if (exact < double(start) && (double(rounded) > exact || rounded == start))
        return std::nextafter(rounded, -infinity);
    return rounded;
}

}  // namespace mote::core
