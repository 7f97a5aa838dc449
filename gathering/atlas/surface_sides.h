// Which sides of a shape take part in the exchange of light.
#pragma once

#include "core/geometry/shape.h"

namespace mote::gathering {

struct SurfaceSides {
    bool front = false, back = false;
    int count() const { return int(front) + int(back); }
};

/// A side takes part if it emits, or if its BSDF has a part that can be evaluated and reflects there.
SurfaceSides sides_of(const core::Shape& shape);

}  // namespace mote::gathering
