// Sums over pixels in index order.
#include "core/metrics/reference_pair.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::core {

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

RelativeError relative_error(std::span<const Rgb> image, const ReferencePair& pair, int width, int height,
                             std::span<const Rgb> image_variance) {
    const PairMean mean = mean_of(pair);
    RelativeWeights weights = relative_weights(mean.picture, mean.variance, width, height);
    weights.norm = 0.0;  // that of the products, whatever is known of variances
    for (std::size_t p = 0; p < mean.picture.size(); ++p)
        weights.norm += weights.weight[p] * mean_product(pair.first[p], pair.second[p]);
    RelativeError result = relative_error(image, mean.picture, weights, image_variance, mean.variance);
    if (!(weights.norm > 0.0)) return result;
    double error = 0.0, bias = 0.0, variance = 0.0;
    for (std::size_t p = 0; p < image.size(); ++p) {
        const double w = weights.weight[p];
        const glm::dvec3 x(image[p]), a(pair.first[p]), b(pair.second[p]);
        const double product = mean_product(x - a, x - b);
        error += w * product, variance += w * w * product * product;
        bias += w * 0.5 * (mean_product(a, x - b) + mean_product(b, x - a));
    }
    result.bias = bias / weights.norm;
    const double squared = std::max(error / weights.norm, result.bias * result.bias);
    result.error = std::sqrt(squared);
    result.error_standard_error = std::sqrt(squared + std::sqrt(variance) / weights.norm) - result.error;
    return result;
}

}  // namespace mote::core
