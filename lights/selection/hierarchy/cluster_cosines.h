// Upper bounds of cosines and phase functions over cones of axes and boxes of directions, for bounds and
// importances of clusters.
#pragma once

#include <cmath>

#include "core/math/vectorize.h"

namespace mote::lights {

/// Rounding error of a cosine, at most.
constexpr float cosine_slack = 4e-6f;

/// The largest cosine between any axis of a cone (cosine and sine of its half angle) and any direction whose
/// component along the cone's axis is at most z, of a length between near and far.
inline float largest_cosine(float z, float inv_near, float inv_far, float cos_angle, float sin_angle) {
    const float c = core::min_of(z * (z > 0.0f ? inv_near : inv_far) + cosine_slack, 1.0f);
    const float s = std::sqrt(core::max_of(1.0f - c * c, 0.0f));
    const float turned = c * cos_angle + s * sin_angle;
    return c >= cos_angle ? 1.0f : turned;
}

/// 4 pi times Henyey-Greenstein's function at most, for |g| of [low, high] and a cosine of at most c to the
/// preferred direction. 1 + g^2 - 2 g c is least at g = c.
inline float largest_lobe(float low, float high, float c) {
    const float g = core::min_of(core::max_of(c, low), high);
    const float d = core::max_of((1.0f - g) * (1.0f - g) + 2.0f * g * core::max_of(1.0f - c, 0.0f), 1e-12f);
    return (1.0f - low * low) / (d * std::sqrt(d));
}

}  // namespace mote::lights
