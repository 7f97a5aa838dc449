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

constexpr double darkest_fraction = 0.01;  ///< of m in Eq. (1)
constexpr double pixels_of_a_glint = 4.0;  ///< that one pixel counts for at most

void check_sizes(std::size_t a, std::size_t b) {
    if (a != b) throw std::invalid_argument("the pictures differ in size");
}

double median_that_is_not_black(std::span<const double> squares) {
    std::vector<double> lit;
    std::copy_if(squares.begin(), squares.end(), std::back_inserter(lit), [](double s) { return s > 0.0; });
    if (lit.empty()) return 0.0;
    const auto middle = lit.begin() + std::ptrdiff_t(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    return *middle;
}

/// |r|^2 that a pixel has for certain.
double certain_square(const Rgb& c, const Rgb& variance) {
    constexpr double deviations = 3.0;
    return sqr(std::max(0.0, std::sqrt(mean_square(c)) - deviations * std::sqrt(mean_of_channels(variance))));
}

/// |r'|^2 of the neighbours' mean; of a picture of one pixel, its own.
double square_of_neighbours(std::span<const Rgb> picture, int x, int y, int width, int height) {
    const std::size_t here = std::size_t(y) * std::size_t(width) + std::size_t(x);
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for_each_near(x, y, width, height, [&](std::size_t q) {
        if (q != here) sum += glm::dvec3(picture[q]), count += 1.0;
    });
    return mean_square(count > 0.0 ? sum / count : glm::dvec3(picture[here]));
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

std::vector<double> light_squares(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                  int width, int height) {
    check_sizes(picture.size(), std::size_t(width) * std::size_t(height));
    if (!variance_of_mean.empty()) check_sizes(picture.size(), variance_of_mean.size());
    std::vector<double> squares(picture.size());
    tbb::parallel_for(0, height, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
            const double own = variance_of_mean.empty() ? mean_square(glm::dvec3(picture[p]))
                                                        : certain_square(picture[p], variance_of_mean[p]);
            squares[p] =
                std::max(square_of_neighbours(picture, x, y, width, height), own / pixels_of_a_glint);
        }
    });
    return squares;
}

std::vector<double> weights_of_squares(std::span<const double> squares) {
    const double darkest = darkest_fraction * median_that_is_not_black(squares);
    std::vector<double> weights(squares.size(), 0.0);
    if (!(darkest > 0.0)) return weights;
    std::transform(squares.begin(), squares.end(), weights.begin(),
                   [darkest](double s) { return 1.0 / (s + darkest); });
    return weights;
}

RelativeWeights relative_weights(std::span<const Rgb> picture, int width, int height) {
    return relative_weights(picture, {}, width, height);
}

RelativeWeights relative_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                 int width, int height) {
    RelativeWeights result{weights_of_squares(light_squares(picture, variance_of_mean, width, height))};
    for (std::size_t p = 0; p < picture.size(); ++p) {
        const double noise = variance_of_mean.empty() ? 0.0 : mean_of_channels(variance_of_mean[p]);
        result.norm += result.weight[p] * (mean_square(glm::dvec3(picture[p])) - noise);
    }
    return result;
}

RelativeWeights lower_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean, int width,
                              int height) {
    std::vector<double> squares = light_squares(picture, variance_of_mean, width, height),
                        own(picture.size());
    for (std::size_t p = 0; p < picture.size(); ++p) {
        own[p] = mean_square(picture[p]) + mean_of_channels(variance_of_mean[p]);
        squares[p] = std::max(squares[p], own[p]);
    }
    RelativeWeights result{weights_of_squares(squares)};
    for (std::size_t p = 0; p < picture.size(); ++p) result.norm += result.weight[p] * own[p];
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
        error += w * square, bias += w * mean_product(r, d);
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
