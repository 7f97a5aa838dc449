// An interval of a mean that is not below 0 contains it in 95 of 100 cases, wherever it is.
#include "core/metrics/bounded_interval.h"

#include <cmath>
#include <numbers>

#include "tests/support/catch.h"

using namespace mote::core;

namespace {

/// Share of normal measurements of theta, of standard deviation 1, whose interval contains it.
template <typename Interval>
double coverage(double theta, const Interval& interval) {
    constexpr double step = 1e-3, reach = 8.0;
    double share = 0.0;
    for (double z = -reach + 0.5 * step; z < reach; z += step) {
        const MeanInterval found = interval(theta + z);
        if (found.low <= theta && theta <= found.high)
            share += step * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    }
    return share;
}

/// The usual interval, around a measurement that is put at the bound where it is below.
MeanInterval put_at_bound(double x) {
    const double at = std::fmax(0.0, x);
    return {std::fmax(0.0, at - normal_quantile), at + normal_quantile};
}

}  // namespace

TEST_CASE("The interval of a bounded mean contains it in 95 of 100 cases", "[metrics][bounded_interval]") {
    // The steps of the integral, and a quantile of two decimals.
    constexpr double tolerance = 4e-4;
    for (const double theta : {0.0, 0.02, 0.3, 1.0, 1.7, 2.5, 3.92, 6.0}) {
        CAPTURE(theta);
        CHECK(std::fabs(coverage(theta, interval_of_bounded_mean) - 0.95) < tolerance);
    }
    CHECK(coverage(0.0, put_at_bound) > 0.97);  // planted
}

TEST_CASE("The interval of a bounded mean has its ends where Feldman and Cousins have them",
          "[metrics][bounded_interval]") {
    double last_low = 0.0, last_high = 0.0;
    for (double x = -30.0; x <= 8.0; x += 0.01) {
        CAPTURE(x);
        const MeanInterval found = interval_of_bounded_mean(x);
        CHECK((found.low >= last_low && found.high > last_high && found.high > found.low));
        last_low = found.low, last_high = found.high;
    }
    CHECK(interval_of_bounded_mean(0.0).high == Approx(1.96));
    CHECK(interval_of_bounded_mean(1.64).low == 0.0);
    CHECK(interval_of_bounded_mean(1.66).low > 0.0);
    CHECK(interval_of_bounded_mean(4.0).low == Approx(2.04));
    CHECK(interval_of_bounded_mean(4.0).high == Approx(5.96));
}
