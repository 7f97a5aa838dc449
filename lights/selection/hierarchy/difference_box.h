// The box that holds the differences y - x of all x of one box and y of another, for loops over lanes.
#pragma once

#include "lights/virtual_lights/vpl_contributions.h"

namespace mote::lights {

/// In scalars, which the compiler makes vectors of [m].
struct DifferenceBox {
    float x0, y0, z0, x1, y1, z1;  ///< lower and upper corner

    /// The square of the least and of the largest distance, and not 0 [m^2].
    float near_squared() const {
        const float x = core::max_of(core::max_of(x0, -x1), 0.0f),
                    y = core::max_of(core::max_of(y0, -y1), 0.0f);
        const float z = core::max_of(core::max_of(z0, -z1), 0.0f);
        return core::max_of(x * x + y * y + z * z, min_distance_squared);
    }
    float far_squared() const {
        const float x = core::max_of(-x0, x1), y = core::max_of(-y0, y1), z = core::max_of(-z0, z1);
        return core::max_of(x * x + y * y + z * z, min_distance_squared);
    }
    /// The square of the distance of the middles, and at least `least` [m^2].
    float middle_squared(float least) const {
        const float x = 0.5f * (x0 + x1), y = 0.5f * (y0 + y1), z = 0.5f * (z0 + z1);
        return core::max_of(x * x + y * y + z * z, least);
    }
    /// The largest component along an axis.
    float largest_along(float x, float y, float z) const {
        return core::max_of(x * x0, x * x1) + core::max_of(y * y0, y * y1) + core::max_of(z * z0, z * z1);
    }
};

}  // namespace mote::lights
