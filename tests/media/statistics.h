// Means with their standard errors, and the two goodness-of-fit tests that the media tests use.
//
// Every comparison is a z-test at a stated number of standard errors: at 5 sigma a right estimator fails once
// in two million values, and a wrong one fails whenever its error exceeds 5 standard errors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace mote::tests {

class Mean {
  public:
    void add(double x) {
        ++count_;
        const double delta = x - mean_;
        mean_ += delta / double(count_);
        squares_ += delta * (x - mean_);
    }
    double value() const { return mean_; }
    double standard_error() const {
        return count_ < 2 ? 0.0 : std::sqrt(squares_ / double(count_ - 1) / double(count_));
    }
    /// Standard errors between the mean and `expected`. `floor` is the error that rounding alone may make.
    double sigmas_from(double expected, double floor = 1e-7) const {
        const double error = std::max(standard_error(), floor * std::max(1e-300, std::fabs(expected)));
        return std::fabs(mean_ - expected) / error;
    }

  private:
    std::size_t count_ = 0;
    double mean_ = 0.0, squares_ = 0.0;
};

/// The probability of a Kolmogorov-Smirnov distance at least as large as that of `samples` from the
/// distribution function `cdf` (Marsaglia et al. 2003 give the exact law; this is its limit for many
/// samples).
inline double kolmogorov_smirnov_p(std::vector<double> samples, const std::function<double(double)>& cdf) {
    std::sort(samples.begin(), samples.end());
    const double n = double(samples.size());
    double d = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double f = cdf(samples[i]);
        d = std::max({d, f - double(i) / n, double(i + 1) / n - f});
    }
    const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * d;
    double p = 0.0;
    for (int k = 1; k <= 100; ++k) p += (k % 2 ? 2.0 : -2.0) * std::exp(-2.0 * k * k * lambda * lambda);
    return std::clamp(p, 0.0, 1.0);
}

/// Chi-squared statistic of counts against expected counts, bins with fewer than five expected pooled, as
/// standard deviations above its mean (Wilson & Hilferty 1931).
inline double chi_squared_sigmas(const std::vector<double>& counts, const std::vector<double>& expected) {
    double statistic = 0.0, pooled_count = 0.0, pooled_expected = 0.0;
    int bins = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        pooled_count += counts[i], pooled_expected += expected[i];
        if (pooled_expected < 5.0) continue;
        statistic += (pooled_count - pooled_expected) * (pooled_count - pooled_expected) / pooled_expected;
        pooled_count = pooled_expected = 0.0, ++bins;
    }
    const double k = std::max(1, bins - 1), v = 2.0 / (9.0 * k);
    return (std::cbrt(statistic / k) - (1.0 - v)) / std::sqrt(v);
}

}  // namespace mote::tests
