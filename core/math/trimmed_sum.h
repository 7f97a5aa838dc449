// Sums of values of which a few would decide alone: bright paths of a short trial, pixels with fireflies.
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <span>

namespace mote::core {

/// Sum of the values without the `left_out` largest, of which there may be as many as values; reorders them.
inline double sum_without_largest(std::span<double> values, std::size_t left_out) {
    const auto last = values.end() - std::ptrdiff_t(left_out);
    if (left_out > 0) std::nth_element(values.begin(), last, values.end());
    return std::accumulate(values.begin(), last, 0.0);
}

}  // namespace mote::core
