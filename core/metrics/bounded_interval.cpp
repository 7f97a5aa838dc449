#include "core/metrics/bounded_interval.h"

#include <cmath>
#include <numbers>

namespace mote::core {

namespace {

constexpr double confidence = 0.95;

/// Share of the normal distribution below x.
double share_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Where a share of the measurements, rising or falling in theta, is 95 %.
template <typename Share>
double theta_of_confidence(const Share& share, double below, double above) {
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (below + above);
        (share(middle) < confidence ? below : above) = middle;
    }
    return above;
}

/// Where x is x_1 < 0: by R(x_1) = R(x_2), x_2 - theta = sqrt(theta^2 - 2 theta x).
double upper_end(double x) {
    if (x >= 0.0) return x + normal_quantile;
    const auto share = [x](double theta) {
        return share_below(std::sqrt(theta * (theta - 2.0 * x))) - share_below(x - theta);
    };
    return theta_of_confidence(share, 0.0, normal_quantile);
}

/// Where x is x_2: by R(x_1) = R(x_2), x_1 = x - x^2 / (2 theta), if that is below 0.
double lower_end(double x) {
    if (x >= 2.0 * normal_quantile) return x - normal_quantile;
    if (share_below(x) <= confidence) return 0.0;
    const auto share = [x](double theta) {
        return share_below(x - theta) - share_below(x - 0.5 * x * x / theta - theta);
    };
    return theta_of_confidence(share, 0.5 * x, 0.0);
}

}  // namespace

MeanInterval interval_of_bounded_mean(double x) { return {lower_end(x), upper_end(x)}; }

}  // namespace mote::core
