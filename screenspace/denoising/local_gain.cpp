#include "screenspace/denoising/local_gain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/film/for_each_pixel.h"
#include "screenspace/denoising/box_sums.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr int radius = 5;  ///< of windows, as of those in which a denoised layer is mixed with its mean

constexpr std::uint32_t lowest_level = 4;

constexpr float area(int of_radius) { return float((2 * of_radius + 1) * (2 * of_radius + 1)); }

}  // namespace

float gain_of_ratio(float q, std::uint32_t level) {
    // The right side of Eq. (1) rises with r for r in (0, 1].
    float low = 0.0f, high = 1.0f;
    for (int step = 0; step < 24; ++step) {
        const float r = 0.5f * (low + high);
        (std::pow(r, float(level) - 1.0f) * (2.0f - r) < q ? low : high) = r;
    }
    const float last = std::sqrt(high);
    return q * last / (2.0f - last);  // Eq. (2)
}

std::vector<float> local_gain(int width, int height, std::span<const Rgb> mean, const BlockSquares& squares,
                              std::uint32_t level) {
    const std::size_t pixels = mean.size();
    if (pixels != std::size_t(width) * std::size_t(height) || squares.seen.size() != pixels ||
        squares.expected.size() != pixels)
        throw std::invalid_argument("a layer and its squares differ in size");
    std::vector<float> gain(pixels, 1.0f), light(pixels);
    if (level < lowest_level) return gain;
    for (std::size_t p = 0; p < pixels; ++p)
        light[p] = is_finite(mean[p]) ? average(mean[p] * mean[p]) : 0.0f;
    const std::vector<float> near = box_sums(width, height, light, 1),
                             around = box_sums(width, height, light, radius);
    std::vector<float> seen(pixels, 0.0f), expected(pixels, 0.0f);
    for (std::size_t p = 0; p < pixels; ++p) {
        const float scale = near[p] / area(1) + 0.01f * around[p] / area(radius);
        if (!(scale > 0.0f) || !std::isfinite(squares.seen[p]) || !std::isfinite(squares.expected[p]))
            continue;
        seen[p] = squares.seen[p] / scale, expected[p] = squares.expected[p] / scale;
    }
    const std::vector<float> all_seen = box_sums(width, height, seen, radius),
                             all_expected = box_sums(width, height, expected, radius);
    for_each_pixel(pixels, [&](std::size_t p) {
        if (all_seen[p] > 0.0f && all_expected[p] > 0.0f)
            gain[p] = gain_of_ratio(std::min(1.0f, all_seen[p] / all_expected[p]), level);
    });
    return gain;
}

}  // namespace mote::screenspace
