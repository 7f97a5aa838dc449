// A quick arc tangent, for where in a buffer something is seen.
#pragma once

namespace mote::gathering {

/// atan on [0, 1] within 1e-5 (Abramowitz & Stegun 1964, 4.4.49).
inline float arc_tangent(float x) {
    const float x2 = x * x;
    return x * (0.9998660f + x2 * (-0.3302995f + x2 * (0.1801410f + x2 * (-0.0851330f + x2 * 0.0208351f))));
}

}  // namespace mote::gathering
