#include "core/metrics/control_error.h"

#include <algorithm>
#include <cmath>

namespace mote::core {

namespace {

constexpr int reach = 1;           ///< of neighbours: 3 x 3 blocks
constexpr double max_scale = 8.0;  ///< of light that an image misses; beyond, its weights say no more

/// Brightness of the control passes over that of the image, around each block.
std::vector<double> scales(std::span<const Rgb> image, const RelativeWeights& weights,
                           const ControlSamples& samples) {
    std::vector<double> of_image, of_control;
    for (const ControlSample& s : samples.blocks) {
        // The weights of errors, to the first power of the light.
        const double w = s.pixels * std::sqrt(weights.weight[s.pixel]);
        of_image.push_back(w * mean_of_channels(image[s.pixel]));
        of_control.push_back(w * 0.5 * (mean_of_channels(s.a) + mean_of_channels(s.b)));
    }
    std::vector<double> result;
    for (int y = 0; y < samples.rows; ++y)
        for (int x = 0; x < samples.columns; ++x) {
            double image_around = 0.0, control_around = 0.0;
            for (int v = std::max(0, y - reach); v <= std::min(samples.rows - 1, y + reach); ++v)
                for (int u = std::max(0, x - reach); u <= std::min(samples.columns - 1, x + reach); ++u) {
                    if (u == x && v == y) continue;
                    const auto k = std::size_t(v * samples.columns + u);
                    image_around += of_image[k], control_around += of_control[k];
                }
            const bool known = image_around > 0.0 && control_around > 0.0;
            result.push_back(known ? std::clamp(control_around / image_around, 1.0 / max_scale, max_scale)
                                   : 1.0);
        }
    return result;
}

}  // namespace

RelativeWeights control_weights(std::span<const Rgb> image, const RelativeWeights& weights,
                                const ControlSamples& samples, int width) {
    double pixels = 0.0, sum = 0.0;
    for (const double w : weights.weight) sum += w, pixels += w > 0.0 ? 1.0 : 0.0;
    if (!(sum > 0.0)) return weights;
    // w = 1 / (|r|^2 + c) with the same c for all pixels, so sum w |r|^2 = sum (1 - c w).
    const double c = (pixels - weights.noise_norm) / sum;
    const std::vector<double> scale = scales(image, weights, samples);
    std::vector<double> squares(image.size());
    for (std::size_t p = 0; p < squares.size(); ++p) {
        const auto row = int(p / std::size_t(width)) / control_block_height,
                   column = int(p % std::size_t(width)) / control_block_width;
        const double s = scale[std::size_t(row * samples.columns + column)];
        squares[p] = weights.weight[p] > 0.0 ? s * s * std::max(0.0, 1.0 / weights.weight[p] - c) : 0.0;
    }
    RelativeWeights result{weights_of_squares(squares)};
    for (std::size_t p = 0; p < squares.size(); ++p) result.noise_norm += result.weight[p] * squares[p];
    result.norm = result.noise_norm;
    return result;
}

PictureError control_error(std::span<const Rgb> image, const RelativeWeights& weights,
                           const ControlSamples& samples) {
    if (samples.blocks.size() < min_control_samples || !(weights.noise_norm > 0.0)) return {};
    double sum = 0.0, before = 0.0, differences = 0.0;
    for (std::size_t i = 0; i < samples.blocks.size(); ++i) {
        // Back and forth, so that neighbours follow each other.
        const auto columns = std::size_t(samples.columns);
        const std::size_t row = i / columns, along = i % columns;
        const ControlSample& s = samples.blocks[row * columns + (row % 2 == 0 ? along : columns - 1 - along)];
        const glm::dvec3 f(image[s.pixel]);
        const double x = s.pixels * weights.weight[s.pixel] *
                         glm::dot(f - glm::dvec3(s.a), f - glm::dvec3(s.b)) / 3.0;  // Eq. (2)
        if (i > 0) differences += (x - before) * (x - before);
        sum += x, before = x;
    }
    const auto n = double(samples.blocks.size());
    const double variance = n / (2.0 * (n - 1.0)) * differences;  // Eq. (3)
    PictureError result = error_interval({.rest = sum, .variance = variance, .norm = weights.noise_norm});
    if (!(result.high > 0.0)) result.high = result.rule_high;  // X < -1.96 s; no image is without error
    return result;
}

}  // namespace mote::core
