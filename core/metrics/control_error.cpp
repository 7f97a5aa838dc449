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

ControlEstimate control_estimate(const ControlPixels& controls, const std::array<PictureHalf, 2>& halves,
                                 const RelativeWeights& weights) {
    if (controls.chosen.empty()) return {};
    const double m = double(controls.chosen.size());
    ControlEstimate result;
    result.constant = 0.0;
    double squares = 0.0;
    for (const ControlPixel& c : controls.chosen) {
        const Rgb &fa = halves[0].shown[c.pixel], &fb = halves[1].shown[c.pixel];
        const double weight = double(controls.represented[c.pixel]) * weights.weight[c.pixel];
        const double v1 = mean_of_channels(c.variance[0]), v2 = mean_of_channels(c.variance[1]),
                     v = 0.5 * (v1 + v2);
        const double term = weight * (product_of_differences(c.mean[0], fa, c.mean[1], fb) - v);
        result.rest += term, squares += term * term;
        result.constant += weight * weight * (2.0 * v1 * v2 + product_of_differences(fa, fb, fa, fb) * v);
        result.linear += 4.0 * weight * v / m;
    }
    const LeftNoise y = left_noise(controls.represented, halves, weights);
    result.constant += 0.25 * y.squares;
    if (y.sum > 0.0) result.square = std::max(0.0, y.squares / (y.sum * y.sum) - 1.0 / m);
    if (m > 1.0) result.spread = (m * squares - result.rest * result.rest) / (m - 1.0);
    return result;
}

double ControlEstimate::variance(double r) const {
    const auto model = [&](double of) { return constant + (linear + square * of) * of; };
    const double here = model(std::max(0.0, rest));
    if (!(here > 0.0)) return std::max(model(r), spread);
    return model(r) * std::max(1.0, spread / here);
}

SquaredError with_controls(const SquaredError& of_halves, const ControlEstimate& of_controls) {
    const double r = std::max(0.0, 0.5 * (of_halves.rest + of_controls.rest));
    const double a = of_halves.variance, b = of_controls.variance(r);
    if (!std::isfinite(b) || !(a + b > 0.0)) return of_halves;
    SquaredError result = of_halves;
    const double weight_of_halves = b / (a + b);
    result.rest = weight_of_halves * of_halves.rest + (1.0 - weight_of_halves) * of_controls.rest;
    const auto variance = [&](double at) {
        return sqr(weight_of_halves) * a + sqr(1.0 - weight_of_halves) * of_controls.variance(at);
    };
    result.variance = variance(r);
    double end = r;
    for (int step = 0; step < 4; ++step)
        end = std::max(0.0, result.rest) + normal_quantile * std::sqrt(variance(end));
    result.more_above = std::max(0.0, variance(end) - result.variance);
    return result;
}

}  // namespace mote::core
