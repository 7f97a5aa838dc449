// Russian roulette for eye paths: survival follows what is left of the throughput.
#pragma once

#include "core/scene/russian_roulette.h"
#include "lights/direct_light/direct_light.h"

namespace mote::integrators {

/// Decides by `u` whether the path continues, and divides the throughput by the chance so that the mean is
/// kept. `scale` is the square of the product of relative indices of refraction, which cancels the radiance
/// scaling inside glass, and what else changes throughput without a loss.
template <bool Media>
bool survives(core::PathWeights& weights, float scale, int depth, float u) {
    const float remaining = core::max_component(weights.throughput) * scale /
                            lights::channel_average<Media>(weights.unidirectional);
    const float q = core::survival_chance(remaining, depth, core::long_eye_path);
    if (!(u < q)) return false;
    weights.throughput /= q;
    return true;
}

}  // namespace mote::integrators
