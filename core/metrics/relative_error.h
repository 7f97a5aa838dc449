// The one measure of errors and of noise (docs/testing.md, "Error and noise"): relative to the picture, so
// free of its scale, and robust: a visible lamp counts by its pixels.
//
//   |c|^2 = mean over channels of c^2, d = image - r
//   w = 1 / (l + m / 100), l = max(|r'|^2, |r|^2 / 4), m the median of l that is not 0            (1)
//   error^2 = sum w |d|^2 / sum w |r|^2                                                           (2)
//   bias    = sum w <r, d> / sum w |r|^2                                                          (3)
//   noise^2 = sum w v / sum w |r|^2, v the variance of the mean, averaged over channels           (4)
//
// r' is the mean of the 5 x 5 pixels around, without the pixel itself: a reference, a noisy one and a film
// that is judged by its own passes then have the same weights but for the noise of that mean, and the weight
// of a pixel contains no noise of its own. A glint or a lamp of one pixel counts for four at most.
//
// By Cauchy and Schwarz |bias| <= error, and a picture that is (1 + b) r has the bias b and the error |b|.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// <a, b>, averaged over channels.
inline double mean_product(const glm::dvec3& a, const glm::dvec3& b) { return glm::dot(a, b) / 3.0; }
/// |c|^2
inline double mean_square(const glm::dvec3& c) { return mean_product(c, c); }
/// (a - b) (c - d), averaged over channels.
inline double product_of_differences(const Rgb& a, const Rgb& b, const Rgb& c, const Rgb& d) {
    return mean_product(glm::dvec3(a) - glm::dvec3(b), glm::dvec3(c) - glm::dvec3(d));
}
inline double mean_of_channels(const Rgb& c) { return (double(c.x) + double(c.y) + double(c.z)) / 3.0; }

/// The weights w of Eq. (1), and the sum that they are relative to.
struct RelativeWeights {
    std::vector<double> weight;  ///< of every pixel [1 / radiance^2]; 0 everywhere when the picture is black
    double norm = 0.0;           ///< sum w |r|^2, without the noise of r
};

/// Weights of a picture without noise, row by row. All values must be finite. Throws std::invalid_argument
/// when a size does not fit.
RelativeWeights relative_weights(std::span<const Rgb> picture, int width, int height);
/// Weights of a noisy picture; of the pixel itself in Eq. (1) counts what it has for certain, by three
/// standard deviations: with less than two, rare bright paths would hide their own noise. Without variances:
/// as of one without noise. Throws std::invalid_argument when a size does not fit.
RelativeWeights relative_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                 int width, int height);
/// Lower bounds of those weights: l of a pixel is |c|^2 + v, its own with the variance v of its mean, where
/// that is larger. Where rare bright paths make the light of dark surroundings, neighbours that had none are
/// too dark. By these weights v is stated too small: k passes of light b in n make v of k (b / n)^2, so
/// v / (|c|^2 + v) is 1 / (k + 1), whose mean is below the exact 1 / m, where k is Poisson's of mean m.
/// The norm is that of |c|^2 + v likewise. Throws as relative_weights().
RelativeWeights lower_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean, int width,
                              int height);

/// l of Eq. (1), row by row. `variance_of_mean` may be empty: no noise. Throws as relative_weights().
std::vector<double> light_squares(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                  int width, int height);
/// Eq. (1) of l pixel by pixel, however it was found. 0 everywhere when all of it is black.
std::vector<double> weights_of_squares(std::span<const double> squares);

/// Error, bias and noise of a picture against its reference. NaN where the reference is black.
struct RelativeError {
    double error = 0.0;                 ///< Eq. (2), without the reference's own noise where that is known
    double error_standard_error = 0.0;  ///< from the noise of the reference: sqrt(error^2 + s) - error
    double bias = 0.0;                  ///< Eq. (3); the reference's noise makes it lower by up to its square
    double bias_standard_error = 0.0;   ///< from the noise of both where their variances are given
    double noise = 0.0;                 ///< Eq. (4) of the image; 0 where its variance is not given
};

/// Variances of the means may be empty: unknown, and taken for zero. The error is never below the bias: where
/// the reference's noise subtracts more, the bias is what is left. All values must be finite.
RelativeError relative_error(std::span<const Rgb> image, std::span<const Rgb> reference,
                             const RelativeWeights& weights, std::span<const Rgb> image_variance = {},
                             std::span<const Rgb> reference_variance = {});

}  // namespace mote::core
