#include "screenspace/denoising/refined_regression.h"

#include <tbb/parallel_for.h>

#include <cmath>

#include "screenspace/denoising/box_sums.h"
#include "screenspace/denoising/feature_block.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr int window_radius = 4;

/// Mean over channels of the squared difference; 0 where the colour is not finite, and nothing is known.
std::vector<float> square_differences(std::span<const Rgb> a, std::span<const Rgb> b) {
    std::vector<float> result(a.size());
    tbb::parallel_for(std::size_t(0), a.size(), [&](std::size_t p) {
        const Rgb d = a[p] - b[p];
        result[p] = is_finite(d) ? average(d * d) : 0.0f;
    });
    return result;
}

}  // namespace

Regression refined_regression(int width, int height, std::span<const FeaturePlane> features,
                              std::span<const Rgb> colour, const RegressionSettings& settings, int finest,
                              CancelToken cancelled) {
    Regression result = block_regression(width, height, features, colour, settings, cancelled);
    const float p = float(feature_columns(features));
    for (int side = settings.block / 2; side >= finest && float(side * side) > 2.0f * p; side /= 2) {
        RegressionSettings smaller = settings;
        smaller.block = side;
        const Regression fine = block_regression(width, height, features, colour, smaller, cancelled);
        const std::vector<float> residual = box_sums(width, height, square_differences(colour, fine.colour),
                                                     window_radius),
                                 found =
                                     box_sums(width, height, square_differences(fine.colour, result.colour),
                                              window_radius);
        const float noise_of_fit = refinement_confidence * p / (float(side * side) - p);
        tbb::parallel_for(std::size_t(0), colour.size(), [&](std::size_t i) {
            const float g = found[i] > 0.0f ? std::fmax(0.0f, 1.0f - noise_of_fit * residual[i] / found[i])
                                            : 0.0f;  // Eq. (1)
            result.colour[i] += g * (fine.colour[i] - result.colour[i]);
        });
    }
    return result;
}

}  // namespace mote::screenspace
