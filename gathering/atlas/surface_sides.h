// Sides of a shape that take part in the exchange of light.
#pragma once

#include "core/geometry/shape.h"

namespace mote::gathering {

struct SurfaceSides {
    bool front = false;                                   ///< where the normal points
    bool back = false;                                    ///< the other one
    int count() const { return int(front) + int(back); }  ///< 0 to 2
};

/// A side takes part if it emits, or if its BSDF has a part that can be evaluated and reflects there.
SurfaceSides sides_of(const core::Shape& shape);

}  // namespace mote::gathering
