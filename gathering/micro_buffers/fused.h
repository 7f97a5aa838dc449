// A product and a sum in one instruction, where there is one.
#pragma once

#include <cmath>

namespace mote::gathering {

/// a b + c. Rounded once on processors with such an instruction, which takes a third off the time of a disc;
/// else twice.
inline float fused(float a, float b, float c) {
#ifdef __FMA__
    return std::fma(a, b, c);
#else
    return a * b + c;
#endif
}
/// a . b for the coordinates of two vectors.
inline float fused_dot(float ax, float ay, float az, float bx, float by, float bz) {
    return fused(ax, bx, fused(ay, by, az * bz));
}

}  // namespace mote::gathering
