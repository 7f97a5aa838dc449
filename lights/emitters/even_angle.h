// Directions around an axis whose angles to it are spread evenly over the hemisphere around it:
//   p(w) = 1 / (pi^2 sin theta).
// What varies as 1/sin theta, such as light that a lamp scatters along rays past it, is found by them without
// noise (Georgiev et al. 2013).
#pragma once

#include <optional>

#include "core/math/frame.h"

namespace mote::lights {

/// Density of sample_even_angle() [1/sr]; 0 behind. `axis` has any length; `w` is a unit vector.
inline float even_angle_pdf(const core::Vec3& axis, const core::Vec3& w) {
    const float along = glm::dot(axis, w), length = glm::length(axis);
    if (!(along > 0.0f)) return 0.0f;
    constexpr float min_sine = 1e-7f;  // below what a unit vector resolves
    const float sine = std::max(glm::length(glm::cross(axis, w)) / length, min_sine);
    return 1.0f / (core::sqr(core::pi) * sine);
}

/// A unit vector; nothing where the axis has no length.
inline std::optional<core::Vec3> sample_even_angle(const core::Vec3& axis, const core::Vec2& u) {
    const float length = glm::length(axis);
    if (!(length > 0.0f) || !std::isfinite(length)) return std::nullopt;
    const float theta = 0.5f * core::pi * u.x, phi = 2.0f * core::pi * u.y, sine = std::sin(theta);
    const core::Frame frame(axis / length);
    return glm::normalize(frame.to_world({sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)}));
}

}  // namespace mote::lights
