// The square of a filter's bias from a few pixels that have many samples more: control pixels.
//
// Eq. (2) of halves_error.h holds the halves of a picture against what a filter makes of them. Its variance,
// Eq. (3), is that of the raw halves' noise, many times that of the filtered picture. At some pixels, chosen
// by chance, samples of their own have the means a', b' of two halves, with less noise, and
//
//   B = sum_i A_i w <a' - f_a, b' - f_b>,                                                                (1)
//
// 1 / A_i being how often pixel i is chosen on average, has the mean <e_a, e_b> as well: the noise of a' and
// b' is independent of each other and of the passes. It has the variance of this noise and of the choice of
// the m pixels,
//
//   s'^2 = sum_i A_i^2 w^2 (v_a' v_b' + |f_a - f_b|^2 / 2 (v_a' + v_b'))
//          + Y / 4 + B^2 (Y / (sum y)^2 - 1 / m),   y = w |f_a - f_b|^2,   Y = sum A y^2,                (2)
//
// y being known everywhere, and errors, with the filter's bias, being where its halves differ. The spread of
// the terms of Eq. (1) shows more where the others are among the chosen pixels: the larger of both variances
// counts. B and Eq. (2) of halves_error.h are combined by their variances.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "core/metrics/halves_error.h"

namespace mote::core {

/// A pixel with samples of its own, in two independent halves.
struct ControlPixel {
    std::size_t pixel = 0;                        ///< index in the picture, row by row
    std::array<Rgb, 2> mean = {}, variance = {};  ///< of the halves; the variance is that of the mean
};

/// All that is known of control pixels; none: empty.
struct ControlPixels {
    std::vector<ControlPixel> chosen;    ///< one may be chosen more than once
    std::span<const float> represented;  ///< A of every pixel of the picture
};

/// Estimate of sum w <e_a, e_b> over the picture.
struct RestEstimate {
    double rest = 0.0;                                          ///< its value
    double variance = std::numeric_limits<double>::infinity();  ///< of that value
};

/// Eq. (1) and (2). Nothing is known without control pixels.
RestEstimate control_estimate(const ControlPixels& controls, const std::array<PictureHalf, 2>& halves,
                              const RelativeWeights& weights);

/// The error of a picture by both: its rest and variance are those of the estimates combined by their
/// variances.
SquaredError with_controls(const SquaredError& of_halves, const RestEstimate& of_controls);

}  // namespace mote::core
