// Warps from the unit square to other domains, each with its density. Directions have z up; every pdf is with
// respect to solid angle unless its name says otherwise. Derivations: Pharr 2016, Sec. 13.6.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

// Sine and cosine of |x| <= pi / 4 within an ulp, by the polynomials of Cephes (S. Moshier, sinf.c). Without
// a branch or a call, as vector code has them.
inline float sin_of_octant(float x) {
    const float s = x * x;
    return x + x * s * (-1.6666654611e-1f + s * (8.3321608736e-3f + s * -1.9515295891e-4f));
}
inline float cos_of_octant(float x) {
    const float s = x * x;
    return 1.0f - 0.5f * s +
           s * s * (4.166664568298827e-2f + s * (-1.388731625493765e-3f + s * 2.443315711809948e-5f));
}

/// Unit disk, concentric (Shirley & Chiu 1997). pdf_area = 1/pi.
inline Vec2 square_to_disk(const Vec2& u) {
    const Vec2 offset = 2.0f * u - Vec2(1.0f);
    const bool wide = std::fabs(offset.x) > std::fabs(offset.y);
    const float r = wide ? offset.x : offset.y, other = wide ? offset.y : offset.x;
    const float theta = 0.25f * pi * (other / (r == 0.0f ? 1.0f : r));  // from the axis of r
    const float along = r * cos_of_octant(theta), across = r * sin_of_octant(theta);
    return {wide ? along : across, wide ? across : along};
}

/// Hemisphere with density cos(theta)/pi, by Malley's method (Sec. 13.6.3). Never returns z = 0.
inline Vec3 square_to_cosine_hemisphere(const Vec2& u) {
    const Vec2 d = square_to_disk(u);
    const float z = safe_sqrt(1.0f - d.x * d.x - d.y * d.y);
    return {d.x, d.y, z > 1e-6f ? z : 1e-6f};
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
