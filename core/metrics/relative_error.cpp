// Weights, and sums over pixels in index order.
#include "core/metrics/relative_error.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/metrics/neighbourhood.h"

namespace mote::core {

namespace {

constexpr double certain_deviations = 3.0;
constexpr double darkest_fraction = 0.01;  ///< (1 / 10)^2 in Eq. (1)

void check_sizes(std::size_t a, std::size_t b) {
    if (a != b) throw std::invalid_argument("the pictures differ in size");
}

double median_that_is_not_black(const std::vector<double>& squares) {
    std::vector<double> lit;
    std::copy_if(squares.begin(), squares.end(), std::back_inserter(lit), [](double s) { return s > 0.0; });
    if (lit.empty()) return 0.0;
    const auto middle = lit.begin() + std::ptrdiff_t(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    return *middle;
}

/// Eq. (1) from `squares`, |r|^2 pixel by pixel; m is the median of `level`.
std::vector<double> weights_of(const std::vector<double>& squares, const std::vector<double>& level) {
    const double darkest = darkest_fraction * median_that_is_not_black(level);
    std::vector<double> weights(squares.size(), 0.0);
    if (!(darkest > 0.0)) return weights;
    std::transform(squares.begin(), squares.end(), weights.begin(),
                   [darkest](double s) { return 1.0 / (s + darkest); });
    return weights;
}

/// A noisy picture without most of its noise.
struct Smoothed {
    std::vector<double> others;  ///< |mean of the neighbours|^2, without the pixel itself where that can be
    std::vector<double> all;     ///< the same with it
};

Smoothed smoothed(std::span<const Rgb> picture, std::span<const Rgb> variance, int width, int height) {
    check_sizes(picture.size(), variance.size());
    check_sizes(picture.size(), std::size_t(width) * std::size_t(height));
    Smoothed s{std::vector<double>(picture.size()), std::vector<double>(picture.size())};
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
            const AlikeNeighbours near = alike_neighbours(picture, variance, x, y, width, height);
            const glm::dvec3 here(picture[p]), all = (near.sum + here) / (near.count + 1.0);
            const glm::dvec3 others = near.count > 0.0 ? near.sum / near.count : here;
            s.others[p] = std::max(mean_square(others), certain_square(picture[p], variance[p]));
            s.all[p] = mean_square(all);
        }
    });
    return s;
}

/// Variance of <r, x> where x has these variances and its channels move together.
double variance_of_product(const Rgb& r, const Rgb& variance) {
    const double deviation = (std::fabs(double(r.x)) * std::sqrt(double(variance.x)) +
                              std::fabs(double(r.y)) * std::sqrt(double(variance.y)) +
                              std::fabs(double(r.z)) * std::sqrt(double(variance.z))) /
                             3.0;
    return deviation * deviation;
}

}  // namespace

double certain_square(const Rgb& c, const Rgb& variance) {
    const double least =
        std::sqrt(mean_square(c)) - certain_deviations * std::sqrt(mean_of_channels(variance));
    return least > 0.0 ? least * least : 0.0;
}

std::vector<double> weights_of_squares(const std::vector<double>& squares) {
    return weights_of(squares, squares);
}

RelativeWeights relative_weights(std::span<const Rgb> reference) {
    std::vector<double> squares(reference.size());
    std::transform(reference.begin(), reference.end(), squares.begin(),
                   [](const Rgb& r) { return mean_square(r); });
    RelativeWeights result{weights_of(squares, squares)};
    for (std::size_t p = 0; p < squares.size(); ++p) result.norm += result.weight[p] * squares[p];
    result.noise_norm = result.norm;
    return result;
}

RelativeWeights relative_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                 int width, int height) {
    const Smoothed squares = smoothed(picture, variance_of_mean, width, height);
    RelativeWeights result{weights_of(squares.others, squares.all)};
    for (std::size_t p = 0; p < picture.size(); ++p) {
        result.norm += result.weight[p] * mean_square(picture[p]);
        result.noise_norm += result.weight[p] * squares.all[p];
    }
    return result;
}

RelativeWeights lower_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean, int width,
                              int height) {
    Smoothed squares = smoothed(picture, variance_of_mean, width, height);
    for (std::size_t p = 0; p < picture.size(); ++p)
        squares.others[p] =
            std::max(squares.others[p], mean_square(picture[p]) + mean_of_channels(variance_of_mean[p]));
    RelativeWeights result{weights_of(squares.others, squares.all)};
    for (std::size_t p = 0; p < picture.size(); ++p)
        result.noise_norm += result.weight[p] * squares.others[p];
    result.norm = result.noise_norm;
    return result;
}

RelativeError relative_error(std::span<const Rgb> image, std::span<const Rgb> reference,
                             const RelativeWeights& weights, std::span<const Rgb> image_variance,
                             std::span<const Rgb> reference_variance) {
    check_sizes(image.size(), reference.size());
    check_sizes(image.size(), weights.weight.size());
    double error = 0.0, bias = 0.0, noise = 0.0, subtracted = 0.0, error_variance = 0.0, bias_variance = 0.0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const double w = weights.weight[p];
        const glm::dvec3 r(reference[p]), d = glm::dvec3(image[p]) - r;
        const double square = mean_square(d);
        error += w * square, bias += w * glm::dot(r, d) / 3.0;
        if (!image_variance.empty()) {
            noise += w * mean_of_channels(image_variance[p]);
            bias_variance += w * w * variance_of_product(reference[p], image_variance[p]);
        }
        if (!reference_variance.empty()) {
            // d = D + n with n of variance v: |d|^2 has the mean D^2 + v and the variance 4 D^2 v + 2 v^2 at
            // most.
            const double v = mean_of_channels(reference_variance[p]);
            subtracted += w * v;
            error_variance += w * w * (4.0 * std::max(0.0, square - v) * v + 2.0 * v * v);
            bias_variance += w * w * variance_of_product(reference[p], reference_variance[p]);
        }
    }
    const double norm = weights.norm;
    if (!(norm > 0.0)) {
        const double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, unknown, unknown, unknown};
    }
    RelativeError result;
    result.bias = bias / norm, result.bias_standard_error = std::sqrt(bias_variance) / norm;
    const double squared = std::max((error - subtracted) / norm, result.bias * result.bias);
    result.error = std::sqrt(squared);
    result.error_standard_error = std::sqrt(squared + std::sqrt(error_variance) / norm) - result.error;
    result.noise = std::sqrt(noise / norm);
    return result;
}

}  // namespace mote::core
