// The square of a filter's bias from a few pixels that have many samples more: control pixels.
//
// Eq. (2) of halves_error.h holds the halves of a picture against what a filter makes of them. Its variance,
// Eq. (3), is that of the raw halves' noise, many times that of the filtered picture. At some pixels, chosen
// by chance, samples of their own have a mean c of variance v, which is estimated without bias. The sum
//
//   B = sum_i A_i w (<a' - f_a, b' - f_b> - v),   a' = b' = c,                                          (1)
//
// 1 / A_i being how often pixel i is chosen on average, has the mean <e_a, e_b> as well: the noise of c is
// independent of the passes, and |c|^2 - v has the mean |mu|^2. That is the product of all pairs of samples,
// of half the variance that halves of them would have; a rare bright sample cancels. Parts of the light
// without samples of their own are in a' and b' as the halves of the passes have them. Where the rest is R,
// B has the variance of this noise and of the choice of the m pixels,
//
//   s'^2 = sum_i A_i^2 w^2 (2 v_1 v_2 + v |f_a - f_b|^2) + 4 R / m sum_i A_i w v
//          + Y / 4 + R^2 (Y / (sum y)^2 - 1 / m),   y = w |f_a - f_b|^2,   Y = sum A y^2,                (2)
//
// v_1 and v_2 being v by either half of the samples: v^2 would be too large on average. |e_a + e_b|^2, which
// v is multiplied with, is |f_a - f_b|^2 + 4 <e_a, e_b>, the latter being where pixels are chosen often; and
// y is known everywhere, and errors, with the filter's bias, are where the filter's halves differ. The spread
// of the terms of Eq. (1) shows more where they are not: Eq. (2) is then larger by as much for all R.
//
// B and Eq. (2) of halves_error.h are combined by their variances. Estimates that are low by chance come with
// variances that are low, by the terms with R: R is the mean of both there, and the interval ends above at
// that rest R from which the estimate is 1.96 times s(R) away (a score interval, Wilson 1927).
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "core/metrics/halves_error.h"

namespace mote::core {

/// A pixel with samples of its own.
struct ControlPixel {
    std::size_t pixel = 0;         ///< index in the picture, row by row
    std::array<Rgb, 2> mean = {};  ///< a' and b' of Eq. (1)
    /// Of the noise that both share: v_1 and v_2, independent and without bias. Their mean is v.
    std::array<Rgb, 2> variance = {};
};

/// All that is known of control pixels; none: empty.
struct ControlPixels {
    std::vector<ControlPixel> chosen;    ///< one may be chosen more than once
    std::span<const float> represented;  ///< A of every pixel of the picture
};

/// Estimate of sum w <e_a, e_b> over the picture, by control pixels.
struct ControlEstimate {
    double rest = 0.0;  ///< B
    /// Of Eq. (2), and the factors of R and of R^2 there.
    double constant = std::numeric_limits<double>::infinity(), linear = 0.0, square = 0.0;
    double spread = 0.0;  ///< variance of B as the terms of Eq. (1) show it
    /// Variance of B where the rest is `r`, not below 0.
    double variance(double r) const;
};

/// Eq. (1) and (2). The variance is infinite without control pixels.
ControlEstimate control_estimate(const ControlPixels& controls, const std::array<PictureHalf, 2>& halves,
                                 const RelativeWeights& weights);

/// The error of a picture by both.
SquaredError with_controls(const SquaredError& of_halves, const ControlEstimate& of_controls);

}  // namespace mote::core
