// Directions on the octahedron |x| + |y| + |z| = 1 (Engelhardt 2013, Ch. 7): the sphere unfolded to a square,
// a hemisphere to a square of its own, and unit vectors in 32 bits, whose error is below 1e-4 rad.
#pragma once

#include <algorithm>

#include "core/math/vec.h"

namespace mote::core {

/// Eqs. 7.1 and 7.2, the unfolded octahedron: [-1, 1]^2, z up in the middle. sign(0) is +1, so that no axis
/// collapses (docs/errata.md).
inline Vec2 octahedral_project(const Vec3& v) {
    const float scale = 1.0f / (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
    const Vec2 p = scale * Vec2(v.x, v.y);
    if (v.z >= 0.0f) return p;
    return {std::copysign(1.0f - std::fabs(p.y), p.x), std::copysign(1.0f - std::fabs(p.x), p.y)};
}

inline Vec3 octahedral_unproject(const Vec2& p) {
    Vec3 v(p.x, p.y, 1.0f - std::fabs(p.x) - std::fabs(p.y));
    if (v.z < 0.0f) {
        v.x = std::copysign(1.0f - std::fabs(p.y), p.x);
        v.y = std::copysign(1.0f - std::fabs(p.x), p.y);
    }
    return glm::normalize(v);
}

/// The upper half of the octahedron, turned by 45 degrees so that it fills [-1, 1]^2 (Eqs. 7.1 and 7.3,
/// without the shift). Directions with z < 0 are mirrored at the horizon.
inline Vec2 hemi_octahedral_project(const Vec3& v) {
    const float scale = 1.0f / (std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
    return scale * Vec2(v.x - v.y, v.x + v.y);
}

inline Vec3 hemi_octahedral_unproject(const Vec2& q) {
    const Vec2 p = 0.5f * Vec2(q.x + q.y, q.y - q.x);
    return glm::normalize(Vec3(p, std::fmax(1.0f - std::fabs(p.x) - std::fabs(p.y), 0.0f)));
}

/// `v` need not have unit length, but must not be zero.
inline std::uint32_t encode_direction(const Vec3& v) {
    const Vec2 p = octahedral_project(v);
    const auto quantize = [](float x) {
        return std::uint32_t(std::lround((std::clamp(x, -1.0f, 1.0f) * 0.5f + 0.5f) * 65535.0f));
    };
    return quantize(p.x) | quantize(p.y) << 16;
}
inline Vec3 decode_direction(std::uint32_t code) {
    const auto expand = [](std::uint32_t bits) { return float(bits) * (2.0f / 65535.0f) - 1.0f; };
    return octahedral_unproject({expand(code & 0xffffu), expand(code >> 16)});
}

}  // namespace mote::core
