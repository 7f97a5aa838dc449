// The error against two references that were rendered with different seeds. Their noises are independent of
// each other, so the product of the differences from both has no part of either:
//
//   error^2 = sum w <x - a, x - b> / sum w <a, b>
//   bias    = sum w (<a, x - b> + <b, x - a>) / 2 / sum w <a, b>
//
// in expectation, whatever their variances are; none has to be known. So a pair of 4 % judges errors of far
// below 1 %, also where passes are not independent or outliers hide from estimates of variance.
//
// The weights (relative_error.h, Eq. 1) are those of the mean of both.
//
// The remaining error is the scatter of the product. Noises of different pixels of path-traced references are
// independent, so its variance is the sum of its squares where noise dominates, and less where the error
// differs from place to place.
#pragma once

#include <span>
#include <vector>

#include "core/metrics/relative_error.h"

namespace mote::core {

struct ReferencePair {
    std::span<const Rgb> first, second;
    std::span<const Rgb> first_variance, second_variance;  ///< of the means; empty where not known
};

/// Mean of both references, and the variance of that mean, taken from their difference where it is not known.
struct PairMean {
    std::vector<Rgb> picture, variance;
};
/// Throws std::invalid_argument when the sizes differ.
PairMean mean_of(const ReferencePair& pair);

/// error and bias against the truth that both are estimates of. As always, the error is never below the bias.
/// `image_variance` may be empty. Throws std::invalid_argument when a size does not fit.
RelativeError relative_error(std::span<const Rgb> image, const ReferencePair& pair, int width, int height,
                             std::span<const Rgb> image_variance = {});

}  // namespace mote::core
