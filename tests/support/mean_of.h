// The mean of many draws, and how far it may be off.
#pragma once

#include <algorithm>
#include <cmath>

namespace mote::tests {

struct Mean {
    double mean, error;  ///< error: standard deviation of the mean
};

/// Mean of `draws` calls of draw(), with its standard error.
template <typename Draw>
Mean mean_of(int draws, const Draw& draw) {
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < draws; ++k) {
        const double x = draw();
        sum += x, squares += x * x;
    }
    const double mean = sum / draws;
    return {mean, std::sqrt(std::max(0.0, squares / draws - mean * mean) / (draws - 1.0))};
}

}  // namespace mote::tests
