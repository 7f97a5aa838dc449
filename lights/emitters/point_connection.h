// The connection from a receiver to a light that is a single point.
#pragma once

#include <optional>

#include "core/scene/emitter.h"

namespace mote::lights {

/// Direction and inverse square of the distance to `light`; weight holds 1/d^2 in every channel. Nothing on
/// the light itself, and nearer than float can hold: there the light has no finite irradiance.
inline std::optional<core::DirectSample> connect_to_point(const core::Vec3& p, const core::Vec3& light) {
    const core::Vec3 d = light - p;
    const float squared = glm::dot(d, d);
    if (!(squared > 1e-30f) || !std::isfinite(squared)) return std::nullopt;
    const float distance = std::sqrt(squared);
    core::DirectSample sample{};
    sample.wi = d / distance, sample.distance = distance;
    sample.weight = core::Rgb(1.0f / squared);
    sample.delta = true;
    return sample;
}

/// The connection with the light's radiant intensity [W/sr] in the direction away from it. Nothing where it
/// is black.
template <typename Intensity>
std::optional<core::DirectSample> connect_to_point(const core::Vec3& p, const core::Vec3& light,
                                                   const Intensity& intensity) {
    auto sample = connect_to_point(p, light);
    if (!sample) return std::nullopt;
    sample->weight *= intensity(-sample->wi);
    if (core::is_black(sample->weight) || !core::is_finite(sample->weight)) return std::nullopt;
    return sample;
}

}  // namespace mote::lights
