// Cones of directions: an axis and the angle within which all directions of a set lie.
#pragma once

#include <algorithm>

#include "core/math/vec.h"

namespace mote::core {

/// An angle of [0, pi] by its cosine and sine, so that angles are compared and subtracted without arc
/// functions.
struct AngleOf {
    float cos = 1.0f, sin = 0.0f;

    static AngleOf radians(float a) { return {std::cos(a), std::sin(a)}; }
    static AngleOf cosine(float c) {
        c = std::clamp(c, -1.0f, 1.0f);
        return {c, safe_sqrt(1.0f - c * c)};
    }
    static AngleOf straight() { return {-1.0f, 0.0f}; }
    float in_radians() const { return std::atan2(sin, cos); }
};

/// max(0, a - b).
inline AngleOf minus(const AngleOf& a, const AngleOf& b) {
    const bool nothing = a.cos >= b.cos;
    return {nothing ? 1.0f : a.cos * b.cos + a.sin * b.sin, nothing ? 0.0f : a.sin * b.cos - a.cos * b.sin};
}

struct DirectionCone {
    Vec3 axis{0, 0, 1};
    float angle = -1.0f;  ///< between the axis and the directions farthest from it [radians]; below 0: empty

    bool empty() const { return angle < 0.0f; }
    static DirectionCone all() { return {{0, 0, 1}, pi}; }
    /// One direction, unit.
    static DirectionCone of(const Vec3& direction) { return {direction, 0.0f}; }
};

/// The narrowest cone around two.
inline DirectionCone united(const DirectionCone& a, const DirectionCone& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    const DirectionCone &wide = a.angle >= b.angle ? a : b, &narrow = a.angle >= b.angle ? b : a;
    const Vec3 across = glm::cross(wide.axis, narrow.axis);
    const float sine = glm::length(across), between = std::atan2(sine, glm::dot(wide.axis, narrow.axis));
    if (std::min(between + narrow.angle, pi) <= wide.angle) return wide;
    const float angle = 0.5f * (wide.angle + between + narrow.angle);
    if (!(angle < pi) || !(sine > 0.0f)) return DirectionCone::all();
    // The wide cone's axis, turned towards the other's until both fit.
    const float turn = angle - wide.angle;
    const Vec3 aside = glm::normalize(glm::cross(across, wide.axis));
    return {glm::normalize(std::cos(turn) * wide.axis + std::sin(turn) * aside), angle};
}

}  // namespace mote::core
