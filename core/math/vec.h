// Vectors, colours and the few scalar helpers used everywhere.
//
// Lengths are metres, colours are linear RGB. Geometry is single precision because Embree is; anything that
// accumulates (film, transforms at load time, optical depth) is double precision.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace mote::core {

/// A point or direction of the plane.
using Vec2 = glm::vec2;
/// A point or direction of space.
using Vec3 = glm::vec3;
/// A point or direction in double precision.
using Vec3d = glm::dvec3;
/// A pixel.
using Vec2i = glm::ivec2;
using Rgb = glm::vec3;  ///< linear RGB: radiance, reflectance, coefficients per channel

inline constexpr float pi = 3.14159265358979323846f;           ///< pi
inline constexpr float inv_pi = 0.31830988618379067154f;       ///< 1 / pi
inline constexpr float inv_two_pi = 0.15915494309189533577f;   ///< 1 / (2 pi)
inline constexpr float inv_four_pi = 0.07957747154594766788f;  ///< 1 / (4 pi): isotropic scattering [1/sr]
inline constexpr float infinity = std::numeric_limits<float>::infinity();  ///< no end
/// The largest float below 1: samplers return values in [0, one_minus_epsilon].
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

inline float sqr(float x) { return x * x; }  ///< x^2
/// The root, 0 for what rounding made negative.
inline float safe_sqrt(float x) { return std::sqrt(x > 0.0f ? x : 0.0f); }
inline float lerp(float a, float b, float t) { return (1.0f - t) * a + t * b; }   ///< a at t = 0, b at t = 1
inline float average(const Rgb& c) { return (c.x + c.y + c.z) * (1.0f / 3.0f); }  ///< over channels
inline float max_component(const Vec3& v) { return std::fmax(v.x, std::fmax(v.y, v.z)); }  ///< the largest
inline float min_component(const Vec3& v) { return std::fmin(v.x, std::fmin(v.y, v.z)); }  ///< the smallest
/// Rec. 709 luminance.
inline float luminance(const Rgb& c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }
/// No light in any channel.
inline bool is_black(const Rgb& c) { return c.x == 0.0f && c.y == 0.0f && c.z == 0.0f; }
inline bool is_finite(float x) { return std::isfinite(x); }  ///< neither NaN nor infinite
/// All three are finite.
inline bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
/// exp(-x) per channel, in double precision so that large optical depths keep their relative accuracy.
inline Rgb exp_minus(const Rgb& x) {
    return {float(std::exp(-double(x.x))), float(std::exp(-double(x.y))), float(std::exp(-double(x.z)))};
}

}  // namespace mote::core
