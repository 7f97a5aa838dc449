#include "screenspace/denoising/variance_blend.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <stdexcept>

#include "screenspace/denoising/box_sums.h"

namespace mote::screenspace {

using namespace core;

std::vector<Rgb> blend_by_variance(int width, int height, std::span<const Rgb> denoised,
                                   std::span<const Rgb> noisy, std::span<const Rgb> variance, int radius,
                                   float deviations) {
    const std::size_t pixels = denoised.size();
    if (pixels != std::size_t(width) * std::size_t(height) || noisy.size() != pixels ||
        variance.size() != pixels)
        throw std::invalid_argument("pictures and variance differ in size");
    std::vector<float> size(pixels), difference(pixels), expected(pixels), spread(pixels);
    for (std::size_t p = 0; p < pixels; ++p) size[p] = average(denoised[p] * denoised[p]);
    // A pixel counts by its relative error; one that is black beside others as if it were a tenth of them.
    const std::vector<float> around = box_sums(width, height, size, radius);
    const float area = float((2 * radius + 1) * (2 * radius + 1));
    const auto usable = [&](std::size_t p) {
        return is_finite(noisy[p]) && is_finite(variance[p]) && is_finite(denoised[p]);
    };
    for (std::size_t p = 0; p < pixels; ++p) {
        const float scale = size[p] + 0.01f * around[p] / area;
        if (!usable(p) || !(scale > 0.0f)) continue;
        const Rgb d = noisy[p] - denoised[p];
        difference[p] = average(d * d) / scale, expected[p] = average(variance[p]) / scale;
        spread[p] = 2.0f * sqr(expected[p]);
    }
    const std::vector<float> differences = box_sums(width, height, difference, radius),
                             variances = box_sums(width, height, expected, radius),
                             spreads = box_sums(width, height, spread, radius);
    std::vector<Rgb> result(denoised.begin(), denoised.end());
    tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t p) {
        if (!usable(p) || !(differences[p] > 0.0f)) return;
        const float chance = variances[p] + deviations * std::sqrt(spreads[p]);
        const float g = std::fmax(0.0f, 1.0f - chance / differences[p]);  // Eq. (2)
        result[p] += g * (noisy[p] - denoised[p]);
    });
    return result;
}

}  // namespace mote::screenspace
