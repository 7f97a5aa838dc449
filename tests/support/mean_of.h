// The mean of many samples, and how far it may be off.
#pragma once

#include <algorithm>
#include <cmath>

namespace mote::tests {

struct Mean {
    double mean, error;  ///< error: standard deviation of the mean
};

/// Mean of `samples` calls of sample(), with its standard error.
template <typename Sample>
Mean mean_of(int samples, const Sample& sample) {
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < samples; ++k) {
        const double x = sample();
        sum += x, squares += x * x;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / (samples - 1.0))};
}

}  // namespace mote::tests
