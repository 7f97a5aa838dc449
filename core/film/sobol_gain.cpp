// The trend of log2 d is a line whose slope changes from one block size to the next: a Kalman filter follows
// it from the small blocks, of which there are many, to the large ones, each as certain as its number of
// blocks and pixels makes it. How fast slopes change is unknown, and perhaps there is no trend at all: all
// of these explanations count by how probable they make what was seen (model averaging; Kass and Raftery
// 1995), so that little data is taken for independent passes.
//
// Prior, in octaves of d for each doubling of n: slopes of about 1. Edges of one
// dimension have that, smooth integrands 2, noise 0.
#include "core/film/sobol_gain.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace mote::core {

namespace {

constexpr double usual_slope = 1.0;
constexpr double slope_that_lasts = 0.75;  ///< beyond the largest blocks
constexpr double changes_of_slope[] = {0.25, 0.5, 1.0, 2.0, 4.0};

/// Kalman filter with the state (level, slope): means, covariances, and the log of the probability of all
/// that it saw.
struct Trend {
    double level, slope = 0.0, evidence = 0.0;
    double level_variance, covariance = 0.0, slope_variance;

    Trend(double first, double variance, double slope_deviation)
        : level(first), level_variance(variance), slope_variance(slope_deviation * slope_deviation) {}

    void advance(double slope_deviation) {
        slope_variance += slope_deviation * slope_deviation;
        level += slope;
        level_variance += 2.0 * covariance + slope_variance;
        covariance += slope_variance;
    }
    void see(double value, double variance) {
        const double expected = level_variance + variance, surprise = value - level;
        evidence -= 0.5 * (surprise * surprise / expected + std::log(expected));
        const double of_level = level_variance / expected, of_slope = covariance / expected;
        level += of_level * surprise, slope += of_slope * surprise;
        slope_variance -= of_slope * covariance;
        covariance -= of_level * covariance;
        level_variance -= of_level * level_variance;
    }
};

/// Variance of log2 d[k]. Outliers are in all d alike, as sum x^2 / 2n, and say nothing of their trend; what
/// is left are products of different passes, with the relative variance 2 (1 - 2^-(k+1)) a block and pixel.
double variance_of_log(std::size_t k, std::uint32_t n, double pixels) {
    const double of_log = 2.0 * (1.0 - std::exp2(-double(k) - 1.0)) / (double(n >> (k + 1)) * pixels);
    return of_log / (std::log(2.0) * std::log(2.0));
}

Trend trend_of(std::span<const double> d, std::uint32_t n, double pixels, double first_slope, double change) {
    Trend trend(std::log2(d[0]), variance_of_log(0, n, pixels), first_slope);
    for (std::size_t k = 1; k < d.size(); ++k) {
        trend.advance(k > 1 ? change : 0.0);
        trend.see(std::log2(d[k]), variance_of_log(k, n, pixels));
    }
    return trend;
}

/// R[0], R[1], ... up to two beyond d. A sum of parts that fall at different rates falls ever slower: beyond
/// the largest blocks at no more than the trend, and at no less than not at all.
std::vector<double> spreads_of(std::span<const double> d, const Trend& trend) {
    const std::size_t top = d.size();
    const double rate = std::exp2(slope_that_lasts * std::clamp(trend.slope, -2.0, 0.0));
    std::vector<double> r(top + 2);
    r[top - 1] = std::exp2(trend.level) / (1.0 - rate / 2.0);  // Eq. (1)
    r[top] = r[top - 1] * rate, r[top + 1] = r[top] * rate;
    for (std::size_t k = top - 1; k-- > 0;) r[k] = d[k] + r[k + 1] / 2.0;
    return r;
}

/// Variance of the sum of the first n passes. Those beyond the largest block 2^k are part of its twin, and
/// with all of that they would make a block of 2^(k+1).
double variance_of_sum(std::span<const double> r, std::uint32_t n) {
    double variance = 0.0;
    while (n > 0) {
        const auto k = std::size_t(std::bit_width(n)) - 1;
        n -= 1u << k;
        variance += double(1u << k) * r[k] + 2.0 * n * (r[k + 1] - r[k]);
    }
    return variance;
}

double gain_along(std::span<const double> d, std::uint32_t n, const Trend& trend) {
    const std::vector<double> r = spreads_of(d, trend);
    const double of_mean = variance_of_sum(r, n) / (double(n) * n);
    // The sample variance of n points has the mean n (r[0] - of_mean) / (n - 1).
    return of_mean * (n - 1.0) / (r[0] - of_mean);
}

}  // namespace

double sobol_gain(std::span<const double> d, std::uint32_t n, double effective_pixels) {
    // A picture without noise has no trend.
    if (d.empty() || !std::all_of(d.begin(), d.end(), [](double x) { return x > 0.0; })) return 1.0;
    std::vector<double> evidence{trend_of(d, n, effective_pixels, 0.0, 0.0).evidence}, gain{1.0};  // no trend
    for (const double change : changes_of_slope) {
        const Trend trend = trend_of(d, n, effective_pixels, usual_slope, change);
        evidence.push_back(trend.evidence - std::log(double(std::size(changes_of_slope))));
        gain.push_back(gain_along(d, n, trend));
    }
    const double best = *std::max_element(evidence.begin(), evidence.end());
    double sum = 0.0, of_all = 0.0;
    for (std::size_t i = 0; i < gain.size(); ++i) {
        const double odds = std::exp(evidence[i] - best);
        sum += odds * gain[i], of_all += odds;
    }
    return sum / of_all;
}

}  // namespace mote::core
