// Tone curves: from radiance relative to white to what a display shows, both linear.
#pragma once

#include <algorithm>

#include "core/math/vec.h"

namespace mote::core {

/// Display value of one channel; 1 is the display's white, and larger values are shown as white.
using Tone = float (*)(float);

inline float linear_tone(float radiance) { return radiance; }

/// Nearly linear in the dark; highlights are compressed, so that they keep their shape (Hable 2010). 0.18
/// becomes 0.13, 1 becomes 0.49, and white is reached at 5.6. Infinity becomes NaN, for a
/// picture file shows what is not finite.
inline float filmic_tone(float radiance) {
    const auto curve = [](float x) {
        return (x * (0.15f * x + 0.05f) + 0.004f) / (x * (0.15f * x + 0.5f) + 0.06f) - 0.02f / 0.3f;
    };
    return curve(2.0f * std::max(radiance, 0.0f)) / curve(11.2f);
}

inline Rgb toned(Tone tone, const Rgb& radiance) {
    return {tone(radiance.x), tone(radiance.y), tone(radiance.z)};
}

}  // namespace mote::core
