// Extent of a shadow ray towards its target.
#pragma once

#include "core/math/vec.h"
#include "core/math/vectorize.h"

namespace mote::core {

/// Distance from a point within which rounding may place the surface that it lies on [m]: units in the last
/// place of its coordinates, as many as reach a surface that is met at 3 degrees.
inline float rounding_distance(const Vec3& point) {
    return 20.0f * 0x1p-23f * max_of(max_of(std::fabs(point.x), std::fabs(point.y)), std::fabs(point.z));
}

/// End of a shadow ray, as a fraction of the segment from its origin to a surface: rounding must not let it
/// meet the surface there. Far from the origin of coordinates the rounding of both ends exceeds a constant
/// fraction. Positive; 0.9999 where the length is infinite (its inverse 0).
inline float shadow_fraction(const Vec3& origin, float inverse_length) {
    const float end = min_of(1.0f - rounding_distance(origin) * inverse_length, 0.9999f);
    return max_of(end, std::numeric_limits<float>::min());
}

/// End of a shadow ray of unit direction towards a surface at `distance` [m].
inline float shadow_end(const Vec3& origin, float distance) {
    return distance * shadow_fraction(origin, 1.0f / distance);
}

}  // namespace mote::core
