// Sums over pixels in index order.
#include "core/metrics/reference_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/metrics/neighbourhood.h"

namespace mote::core {

namespace {

/// |r|^2 of the neighbours of a pixel alone, their mean.
double neighbours_square(std::span<const Rgb> picture, int width, int height, int x, int y) {
    const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
    double sum = 0.0, count = 0.0;
    for_each_near(x, y, width, height, [&](std::size_t q) {
        if (q != p) sum += mean_square(picture[q]), count += 1.0;
    });
    return count > 0.0 ? sum / count : mean_square(picture[p]);
}

}  // namespace

PairMean mean_of(const ReferencePair& pair) {
    if (pair.first.size() != pair.second.size()) throw std::invalid_argument("the references differ in size");
    const bool known = !pair.first_variance.empty() && !pair.second_variance.empty();
    PairMean mean{std::vector<Rgb>(pair.first.size()), std::vector<Rgb>(pair.first.size())};
    for (std::size_t p = 0; p < pair.first.size(); ++p) {
        const Rgb difference = pair.first[p] - pair.second[p];
        mean.picture[p] = 0.5f * (pair.first[p] + pair.second[p]);
        mean.variance[p] =
            0.25f * (known ? pair.first_variance[p] + pair.second_variance[p] : difference * difference);
    }
    return mean;
}

std::vector<double> weights_of_pair(const PairMean& mean, int width, int height) {
    if (mean.picture.size() != std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("the pictures differ in size");
    std::vector<double> squares(mean.picture.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t p = std::size_t(y) * std::size_t(width) + std::size_t(x);
            squares[p] = std::max(neighbours_square(mean.picture, width, height, x, y),
                                  certain_square(mean.picture[p], mean.variance[p]));
        }
    return weights_of_squares(squares);
}

RelativeError relative_error(std::span<const Rgb> image, const ReferencePair& pair, int width, int height,
                             std::span<const Rgb> image_variance) {
    const PairMean mean = mean_of(pair);
    RelativeWeights weights{weights_of_pair(mean, width, height)};
    for (std::size_t p = 0; p < mean.picture.size(); ++p)
        weights.norm += weights.weight[p] * mean_square(mean.picture[p]);
    RelativeError result = relative_error(image, mean.picture, weights, image_variance, mean.variance);
    double error = 0.0, bias = 0.0, norm = 0.0, variance = 0.0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const double w = weights.weight[p];
        const glm::dvec3 x(image[p]), a(pair.first[p]), b(pair.second[p]);
        const double product = glm::dot(x - a, x - b) / 3.0;
        error += w * product, norm += w * glm::dot(a, b) / 3.0;
        bias += w * 0.5 * (glm::dot(a, x - b) + glm::dot(b, x - a)) / 3.0;
        variance += w * w * product * product;
    }
    if (!(norm > 0.0)) {
        const double unknown = std::numeric_limits<double>::quiet_NaN();
        return {unknown, unknown, unknown, unknown, unknown};
    }
    const double to_pair = weights.norm / norm;  // one reference's noise is in |r|^2, none in <a, b>
    result.bias = bias / norm, result.bias_standard_error *= to_pair, result.noise *= std::sqrt(to_pair);
    const double squared = std::max(error / norm, result.bias * result.bias);
    result.error = std::sqrt(squared);
    result.error_standard_error = std::sqrt(squared + std::sqrt(variance) / norm) - result.error;
    return result;
}

}  // namespace mote::core
