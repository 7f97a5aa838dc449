// A ray segment: origin + t * direction for t in (t_min, t_max). The direction has unit length.
#pragma once

#include "core/math/vec.h"

namespace mote::core {

struct Ray {
    Vec3 origin{0, 0, 0};     ///< [m]
    Vec3 direction{0, 0, 1};  ///< unit
    float t_min = 0.0f;       ///< where the segment begins [m]
    float t_max = infinity;   ///< where it ends [m]

    /// The point at distance t.
    Vec3 at(float t) const { return origin + t * direction; }
};

}  // namespace mote::core
