// Interval of 95 % confidence for a mean that cannot be below 0, as the square of a bias cannot.
//
// A normal measurement x of the mean theta >= 0, in units of its standard deviation, makes it an interval of
// [x - 1.96, x + 1.96]. Cut off at 0, that is too short where x is below 0 by chance, and empty where
// x < -1.96. Feldman and Cousins 1998 accept for each theta those x whose likelihood, relative to the largest
// that any mean has, is highest,
//
//   R(x) = exp(-(x - theta)^2 / 2) where x >= 0,  exp(x theta - theta^2 / 2) where x < 0,               (1)
//
// until they have 95 %: x_1 <= x <= x_2 with R(x_1) = R(x_2). The interval has all theta that accept x. It is
// never empty, is [x - 1.96, x + 1.96] where x >= 3.92, has an upper end of x + 1.96 where x >= 0, and a
// lower end of 0 where x <= 1.645.
#pragma once

namespace mote::core {

struct MeanInterval {
    double low = 0.0, high = 0.0;
};

inline constexpr double normal_quantile = 1.96;  ///< 95 % of the normal distribution are within

/// The interval of a mean that is not below 0, from a measurement; both in standard deviations of that.
MeanInterval interval_of_bounded_mean(double x);

}  // namespace mote::core
