// Extent of a shadow ray towards its target.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

/// Shadow rays stop at this fraction of the segment: rounding must not let them hit the surface at their own
/// end.
inline constexpr float shadow_fraction = 0.9999f;

/// End of a shadow ray of unit direction towards a surface at `distance` [m]. Far from the origin of
/// coordinates the rounding of both ends exceeds that fraction: units in the last place of the coordinates
/// are left out, as many as reach a surface that is met at 3 degrees.
/// `reach`: the largest coordinate of its origin [m].
inline float shadow_end(float reach, float distance) {
    constexpr float rounding = 20.0f * 0x1p-23f;
    const float shorter = shadow_fraction * distance, rounded = distance - rounding * reach;
    return rounded < shorter ? rounded : shorter;
}
inline float shadow_end(const Vec3& origin, float distance) {
    return shadow_end(max_component(glm::abs(origin)), distance);
}

}  // namespace mote::core
