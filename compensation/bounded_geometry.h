// The bounded geometry term, and the fraction of it that the bound takes away.
//
// Engelhardt 2013, Sec. 10.1.3: VPLs are gathered with G_b = min(G*, b), where
//   G*(y,z) = C*(y->z) C*(z->y) / |y - z|^2,  C* the positive cosine on a surface and 1 in a medium.
// The rest is compensated, with the weight
//   B*(y,z) = max(0, G* - b) / G*
// (Eq. 10.10 prints max(0, G*), without the bound; see docs/errata.md). Between two points in a medium it is
// positive inside the radius r = b^(-1/2), where the text prints G^(1/2); cosines only make that region
// smaller.
//
// Both fractions are formed from x = b d^2, never from G* itself: nothing overflows as d -> 0.
#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace mote::compensation {

/// B*, below Eq. 10.11 (on surfaces in Eq. 4.7): the fraction of the light between two points that a bound
/// `bound` [1/m^2] takes away, 0 to 1. `cosines` is C* C*, `distance` in metres. A bound of 0 takes
/// everything, an infinite one nothing. Without cosines there is no light to distribute: 0.
inline float residual_factor(float cosines, float distance, float bound) {
    const float x = bound * distance * distance;
    return std::isfinite(bound) && x < cosines ? 1.0f - x / cosines : 0.0f;
}

/// G_b / G* = min(G*, b) / G* = 1 - B*: what the bound leaves.
inline float bounded_factor(float cosines, float distance, float bound) {
    const float x = bound * distance * distance;
    return std::isfinite(bound) && x < cosines ? x / cosines : 1.0f;
}

/// r = b^(-1/2), Sec. 10.2.2: beyond this distance [m] no bound takes effect. Infinite for b = 0, 0 for an
/// infinite b.
inline float bounding_radius(float bound) { return 1.0f / std::sqrt(bound); }

}  // namespace mote::compensation
