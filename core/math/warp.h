// Warps from the unit square to other domains, each with its density. Directions have z up; every pdf is with
// respect to solid angle unless its name says otherwise. Derivations: Pharr 2016, Sec. 13.6.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

/// Unit disk, concentric (Shirley & Chiu 1997). pdf_area = 1/pi.
inline Vec2 square_to_disk(const Vec2& u) {
    const Vec2 offset = 2.0f * u - Vec2(1.0f);
    if (offset.x == 0.0f && offset.y == 0.0f) return {0.0f, 0.0f};
    float r, theta;
    if (std::fabs(offset.x) > std::fabs(offset.y)) {
        r = offset.x, theta = 0.25f * pi * (offset.y / offset.x);
    } else {
        r = offset.y, theta = 0.5f * pi - 0.25f * pi * (offset.x / offset.y);
    }
    return {r * std::cos(theta), r * std::sin(theta)};
}

/// Hemisphere with density cos(theta)/pi, by Malley's method (Sec. 13.6.3). Never returns z = 0.
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
    const Vec2 d = square_to_disk(u);
    return {d.x, d.y, std::fmax(safe_sqrt(1.0f - d.x * d.x - d.y * d.y), 1e-6f)};
}
inline float cosine_hemisphere_pdf(const Vec3& w) { return w.z > 0.0f ? w.z * inv_pi : 0.0f; }

/// Whole sphere, density 1/(4 pi) (Sec. 13.6.1).
inline Vec3 square_to_sphere(const Vec2& u) {
    const float z = 1.0f - 2.0f * u.x;
    const float r = safe_sqrt(1.0f - z * z), phi = 2.0f * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Cone of half-angle acos(cos_max) around +z, uniform in solid angle (Sec. 13.6.4). `one_minus_cos_max`
/// avoids cancellation.
inline Vec3 square_to_cone(const Vec2& u, float one_minus_cos_max) {
    const float h = u.x * one_minus_cos_max;  // 1 - cos(theta)
    const float r = safe_sqrt(h * (2.0f - h)), phi = 2.0f * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), 1.0f - h};
}
inline float cone_pdf(float one_minus_cos_max) { return inv_two_pi / one_minus_cos_max; }

/// Barycentric coordinates (b1, b2) uniform over a triangle (Sec. 13.6.5); b0 = 1 - b1 - b2.
inline Vec2 square_to_triangle(const Vec2& u) {
    const float su = std::sqrt(1.0f - u.x);
    return {su * (1.0f - u.y), su * u.y};
}

}  // namespace mote::core
