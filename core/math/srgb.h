// The transfer function of sRGB (IEC 61966-2-1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mote::core {

/// The linear value in [0, 1] of an encoded one in [0, 1].
inline float decode_srgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// The eight bits that show a linear value; what lies outside of [0, 1] is clipped. Precondition: not NaN.
inline std::uint8_t encode_srgb(float linear) {
    const float v = std::clamp(linear, 0.0f, 1.0f);
    const float s = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
    return std::uint8_t(std::lround(255.0f * s));
}

}  // namespace mote::core
