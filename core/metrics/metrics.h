// Error metrics of a picture against a reference: each with one definition, in a table that both are printed
// from. The first of them is the error (relative_error.h); the others are what other programs call so.
//
// Nothing is masked. A NaN or an infinity in a picture makes every value that depends on it NaN (null in
// JSON), and the counts of such pixels stand first. Sums are in double precision. d is image - reference, r
// the reference.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "core/math/vec.h"

namespace mote::core {

struct ImageMetrics {
    std::size_t pixels = 0;  ///< of each picture
    /// Pixels with a NaN or an infinity in a channel. `either`: in one picture or in both.
    std::size_t non_finite_image = 0, non_finite_reference = 0, non_finite_either = 0;
    std::array<double, 3> mean_image{}, mean_reference{};  ///< per channel
    double average_image = 0.0, average_reference = 0.0;   ///< over pixels and channels
    double mse = 0.0, rmse = 0.0, mae = 0.0, mape = 0.0, smape = 0.0;
    double rel_mse = 0.0, rel_mse_trimmed = 0.0, mrse = 0.0;
    /// Measures of relative_error.h; standard errors and noise are NaN where the variance that they need is
    /// unknown.
    double error = 0.0, error_standard_error = 0.0, bias = 0.0, bias_standard_error = 0.0, noise = 0.0;
    /// Signed and relative; its error takes pixels for independent, which those of one render need not be.
    double mean_difference = 0.0, mean_difference_standard_error = 0.0;
    double ssim = 0.0;

    /// Fraction of the pixels that are not finite in either picture, in [0, 1].
    double non_finite_fraction() const {
        return pixels == 0 ? 0.0 : double(non_finite_either) / double(pixels);
    }
};

/// Variances of the means of both pictures, pixel by pixel; empty where they are not known.
struct KnownVariances {
    std::span<const Rgb> image, reference;  ///< by pixel, or empty
};

/// Both pictures row by row, width * height pixels. Throws std::invalid_argument when a size does not fit or
/// is zero.
ImageMetrics compare_images(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height,
                            const KnownVariances& variances = {});

/// Mean over channels of d^2 / (r^2 + 0.01) at one pixel; rel_mse is its mean over the pixels.
double relative_squared_error(const Rgb& image, const Rgb& reference);

/// Mean structural similarity of two grey pictures with values in [0, 1] (Wang et al. 2004): Gaussian windows
/// of 11 x 11 pixels, standard deviation 1.5, wholly inside the picture; K1 = 0.01, K2 = 0.03, L = 1. NaN for
/// a picture without room for a window.
double mean_ssim(std::span<const double> image, std::span<const double> reference, int width, int height);

/// One metric that is a single number.
struct MetricDefinition {
    const char* name;             ///< as in JSON
    const char* definition;       ///< one line
    double ImageMetrics::*value;  ///< where it is kept
};
/// All of them, in the order in which they are printed.
std::span<const MetricDefinition> metric_definitions();

}  // namespace mote::core
