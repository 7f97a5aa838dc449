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

/// Below this share of the radiance expected of a pixel a path is subject to roulette: the lower end of the
/// window of Vorba & Křivánek 2016, 2 / (1 + s) with s = 4. Paths above it are not split.
inline constexpr float roulette_window = 0.4f;
/// Lower bound of the probability of survival: expectations may be wrong.
inline constexpr float min_survival = 0.25f;

/// survives() by expected contribution: `expected` is the radiance expected behind the vertex over that of
/// the whole path when it began.
template <bool Media>
bool survives_by_expectation(core::PathWeights& weights, float expected, float u) {
    const float contribution = core::average(lights::throughput_of<Media>(weights)) * expected;
    const float q = std::clamp(contribution / roulette_window, min_survival, 1.0f);
    if (!(u < q)) return false;
    weights.throughput /= q;
    return true;
}

}  // namespace mote::integrators
