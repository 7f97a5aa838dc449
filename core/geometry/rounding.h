// Bounds on the rounding of points on surfaces, and the rounding of origins away from them.
//
// Points are computed in double precision and rounded once. What remains is that rounding, and the error that
// Embree's single-precision triangle test makes when it decides on which side of the triangle a ray starts.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

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

/// The float next to x towards infinity; x is finite. Without a branch, as vector code has it.
inline float next_up(float x) {
    const auto bits = std::bit_cast<std::int32_t>(x + 0.0f);  // -0 has become 0
    return std::bit_cast<float>(bits >= 0 ? bits + 1 : bits - 1);
}
// The functions below are inlined everywhere: a loop over lanes that calls one is no vector code.

/// The float nearest to `exact` that lies at least as far from `start` as exact does. It differs from `start`
/// unless exact == start.
[[gnu::always_inline]] inline float round_away(double exact, float start) {
    const auto rounded = float(exact);
    // Only the signs of the differences count; the factor keeps those of tiny ones.
    const auto ahead = float(0x1p100 * (exact - double(start)));
    const auto missing = float(0x1p100 * (exact - double(rounded)));
    const bool up = (ahead > 0.0f) & ((missing > 0.0f) | (rounded == start));
    const bool down = (ahead < 0.0f) & ((missing < 0.0f) | (rounded == start));
    return up ? next_up(rounded) : down ? -next_up(-rounded) : rounded;
}
/// The origin for a ray leaving `position` in `direction`, moved off the surface to the direction's side far
/// enough that the ray cannot hit the surface it starts on.
[[gnu::always_inline]] inline Vec3 offset_origin(const Vec3& position, const Vec3& geometric_normal,
                                                 float error, const Vec3& direction) {
    // On a plane through the origin nothing is rounded and the error is 0, but a ray that starts on the plane
    // itself meets it at t = 0.
    constexpr float min_offset = 1e-18f;
    const double size = double(error > min_offset ? error : min_offset);
    const double distance = glm::dot(direction, geometric_normal) < 0.0f ? -size : size;
    return {round_away(double(position.x) + distance * double(geometric_normal.x), position.x),
            round_away(double(position.y) + distance * double(geometric_normal.y), position.y),
            round_away(double(position.z) + distance * double(geometric_normal.z), position.z)};
}

}  // namespace mote::core
