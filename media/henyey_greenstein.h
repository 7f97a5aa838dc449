// The Henyey-Greenstein phase function in forms that do not cancel (Henyey & Greenstein 1941).
//
// The textbook forms subtract nearly equal numbers where g is near 0 (sampling) or near +-1 (evaluation).
// Here everything is written in terms of h = 1 - cos(angle to the preferred direction), which is computed
// without subtraction: as half the squared distance of the unit vectors, and in closed form when sampling.
#pragma once

#include "core/math/vec.h"

namespace mote::media {

/// Value and density [1/sr] for h = 1 - cos to the preferred direction, with a = |g| in [0, 1).
inline float henyey_greenstein(float a, float h) {
    const float denominator = (1.0f - a) * (1.0f - a) + 2.0f * a * h;
    return core::inv_four_pi * (1.0f - a) * (1.0f + a) / (denominator * std::sqrt(denominator));
}

/// The h in [0, 2] that a uniform u in [0, 1] maps to; u = 0 is the preferred direction.
/// Inverse of the distribution function, with the subtractions carried out by hand; a -> 0 gives 2u.
inline float sample_henyey_greenstein(float a, float u) {
    const float q = (1.0f - a) + 2.0f * a * (1.0f - u);
    const float h = 2.0f * (1.0f - a) * (1.0f - a) * u * (1.0f + a * (1.0f - u)) / (q * q);
    return std::fmin(h, 2.0f);
}

}  // namespace mote::media
