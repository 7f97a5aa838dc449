// The exponential of a mean, without bias, from independent estimates of that mean.
//
// exp of one of them is off by half its variance. Around it the series of exp is taken in powers of the
// others' differences, to an order that is sampled: seldom any (after Kettunen et al. 2021).
#pragma once

#include <array>

#include "media/tracking_random.h"

namespace mote::media {

/// Probability that the series is evaluated at all. It has a k-th term with probability series_chance / k!,
/// so the k! of the series cancels.
inline constexpr double series_chance = 0.1;
/// Largest order; a higher one has a probability of 2e-11.
inline constexpr std::size_t max_terms = 12;
/// Wide is double, or a vector of them.
template <typename Wide>
using MeanEstimates = std::array<Wide, max_terms + 1>;

/// Samples the number of estimates for exp_of_mean().
inline std::size_t sample_estimates(core::Rng& rng) {
    if (!sample_event(series_chance, rng)) return 1;
    std::size_t count = 2;
    while (count <= max_terms && sample_event(1.0 / double(count), rng)) ++count;
    return count;
}

/// Each estimate is the middle of a series of which the others give the powers (as elementary symmetric
/// means), and the average of all is taken, in which the terms of first order cancel.
template <typename Wide>
Wide exp_of_mean(const MeanEstimates<Wide>& x, std::size_t count) {
    using glm::exp, std::exp;
    if (count == 1) return exp(x[0]);
    Wide sum(0.0);
    for (std::size_t i = 0; i < count; ++i) {
        MeanEstimates<Wide> products;  // sums of those of k differences
        products.fill(Wide(0.0));
        products[0] = Wide(1.0);
        std::size_t seen = 0;
        for (std::size_t j = 0; j < count; ++j) {
            if (j == i) continue;
            ++seen;
            for (std::size_t k = seen; k > 0; --k) products[k] += products[k - 1] * (x[j] - x[i]);
        }
        Wide series(1.0);
        double choices = 1.0;  // count - 1 over k
        for (std::size_t k = 1; k < count; ++k) {
            choices *= double(count - k) / double(k);
            series += products[k] / (choices * series_chance);
        }
        sum += exp(x[i]) * series;
    }
    return sum / double(count);
}

}  // namespace mote::media
