#include "core/metrics/control_error.h"

#include <algorithm>
#include <cmath>

namespace mote::core {

namespace {

/// Sums over all pixels: of y, and of A y^2.
struct LeftNoise {
    double sum = 0.0, squares = 0.0;
};
LeftNoise left_noise(std::span<const float> represented, const std::array<PictureHalf, 2>& halves,
                     const RelativeWeights& weights) {
    LeftNoise result;
    for (std::size_t p = 0; p < represented.size(); ++p) {
        const Rgb &fa = halves[0].shown[p], &fb = halves[1].shown[p];
        const double y = weights.weight[p] * product_of_differences(fa, fb, fa, fb);
        result.sum += y, result.squares += double(represented[p]) * y * y;
    }
    return result;
}

}  // namespace

RestEstimate control_estimate(const ControlPixels& controls, const std::array<PictureHalf, 2>& halves,
                              const RelativeWeights& weights) {
    if (controls.chosen.empty()) return {};
    const double m = double(controls.chosen.size());
    double rest = 0.0, squares = 0.0, variance = 0.0;
    for (const ControlPixel& c : controls.chosen) {
        const Rgb &fa = halves[0].shown[c.pixel], &fb = halves[1].shown[c.pixel];
        const double weight = double(controls.represented[c.pixel]) * weights.weight[c.pixel];
        const double term = weight * product_of_differences(c.mean[0], fa, c.mean[1], fb);
        rest += term, squares += term * term;
        const double va = mean_of_channels(c.variance[0]), vb = mean_of_channels(c.variance[1]);
        variance += weight * weight * (va * vb + 0.5 * product_of_differences(fa, fb, fa, fb) * (va + vb));
    }
    const LeftNoise y = left_noise(controls.represented, halves, weights);
    variance += 0.25 * y.squares;
    if (y.sum > 0.0) variance += rest * rest * std::max(0.0, y.squares / (y.sum * y.sum) - 1.0 / m);
    const double spread = m > 1.0 ? (m * squares - rest * rest) / (m - 1.0) : 0.0;
    return {rest, std::max(variance, spread)};
}

SquaredError with_controls(const SquaredError& of_halves, const RestEstimate& of_controls) {
    const double a = of_halves.variance, b = of_controls.variance;
    if (!std::isfinite(b) || !(a + b > 0.0)) return of_halves;
    SquaredError result = of_halves;
    result.rest = (of_halves.rest * b + of_controls.rest * a) / (a + b);
    result.variance = a * b / (a + b);
    return result;
}

}  // namespace mote::core
