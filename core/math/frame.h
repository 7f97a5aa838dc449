// An orthonormal frame around a normal, and the trigonometry of directions expressed in it (z is the normal).
#pragma once

#include "core/math/vec.h"

namespace mote::core {

struct Frame {
    Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};  ///< local x, y, z as the world sees them

    Frame() = default;
    /// Frame of three orthonormal axes.
    Frame(const Vec3& s_, const Vec3& t_, const Vec3& n_) : s(s_), t(t_), n(n_) {}
    /// Any frame around the unit vector n, without branches or singularities (Duff et al. 2017).
    explicit Frame(const Vec3& normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }

    /// The frame around the unit vector n whose s points along `tangent` as far as n allows; any frame when
    /// it does not allow it at all.
    Frame(const Vec3& normal, const Vec3& tangent) : Frame(normal) {
        const Vec3 across = tangent - n * glm::dot(n, tangent);
        const float length_squared = glm::dot(across, across);
        if (!(length_squared > 1e-8f * glm::dot(tangent, tangent))) return;
        s = across / std::sqrt(length_squared);
        t = glm::cross(n, s);
    }

    /// From the world.
    Vec3 to_local(const Vec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
    Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }  ///< from local coordinates
};

// Trigonometry of a unit direction in the local frame.
inline float cos_theta(const Vec3& w) { return w.z; }
inline float cos2_theta(const Vec3& w) { return w.z * w.z; }                          ///< cos^2
inline float sin2_theta(const Vec3& w) { return std::fmax(0.0f, 1.0f - w.z * w.z); }  ///< sin^2
inline float sin_theta(const Vec3& w) { return std::sqrt(sin2_theta(w)); }            ///< sin, never negative
inline float tan2_theta(const Vec3& w) { return sin2_theta(w) / cos2_theta(w); }      ///< tan^2
/// On one side of the surface.
inline bool same_hemisphere(const Vec3& a, const Vec3& b) { return a.z * b.z > 0.0f; }
/// Mirror of w about the normal of the local frame.
inline Vec3 reflect_local(const Vec3& w) { return {-w.x, -w.y, w.z}; }

}  // namespace mote::core
