// The transfer function of sRGB (IEC 61966-2-1).
#pragma once

#include <cmath>

namespace mote::core {

/// The linear value in [0, 1] of an encoded one in [0, 1].
inline float decode_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace mote::core
