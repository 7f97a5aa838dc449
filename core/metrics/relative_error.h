// The one measure of errors and of noise (docs/testing.md, "Error and noise"): relative to the picture, so
// free of its scale, and robust: a visible lamp counts by its pixels.
//
//   |c|^2 = mean over channels of c^2, d = image - r
//   w = 1 / (|r|^2 + (m / 10)^2), m the median of |r| over the pixels that are not black          (1)
//   error^2 = sum w |d|^2 / sum w |r|^2                                                           (2)
//   bias    = sum w <r, d> / sum w |r|^2                                                          (3)
//   noise^2 = sum w v / sum w |r|^2, v the variance of the mean, averaged over channels           (4)
//
// By Cauchy and Schwarz |bias| <= error, and a picture that is (1 + b) r has the bias b and the error |b|.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

/// |c|^2
inline double mean_square(const glm::dvec3& c) { return glm::dot(c, c) / 3.0; }
/// (a - b) (c - d), averaged over channels.
inline double product_of_differences(const Rgb& a, const Rgb& b, const Rgb& c, const Rgb& d) {
    return glm::dot(glm::dvec3(a) - glm::dvec3(b), glm::dvec3(c) - glm::dvec3(d)) / 3.0;
}
inline double mean_of_channels(const Rgb& c) { return (double(c.x) + double(c.y) + double(c.z)) / 3.0; }

/// |c|^2 that a pixel has for certain, by three standard deviations.
double certain_square(const Rgb& c, const Rgb& variance);

/// The weights w of Eq. (1), and the sum that they are relative to.
struct RelativeWeights {
    std::vector<double> weight;  ///< of every pixel [1 / radiance^2]; 0 everywhere when the picture is black
    double norm = 0.0;           ///< sum w |r|^2
    double noise_norm = 0.0;     ///< sum w |r|^2 of r without most of its noise
};

/// Weights of a reference that is taken for exact. All values must be finite.
RelativeWeights relative_weights(std::span<const Rgb> reference);
/// Weights of a noisy reference whose variance is known, row by row. |r|^2 of a pixel is that of its
/// neighbours: those of 5 x 5 pixels that differ from it by three standard deviations or less; and no less
/// than the pixel is for certain, by three of its own, such as one that a lamp covers in part. From the pixel
/// itself, those that happen to be too bright would have weights too small. Throws std::invalid_argument when
/// a size does not fit.
RelativeWeights relative_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean,
                                 int width, int height);
/// Lower bounds of those weights: |r|^2 of a pixel is |c|^2 + v, its own with the variance v of its mean,
/// where that is larger. Where rare bright paths make the light of dark surroundings, neighbours that had
/// none are too dark. By these weights v is stated too small: k passes of light b in n make v of k (b / n)^2,
/// so v / (|c|^2 + v) is 1 / (k + 1), whose mean is below the exact 1 / m, where k is Poisson's of mean m.
/// Throws as relative_weights().
RelativeWeights lower_weights(std::span<const Rgb> picture, std::span<const Rgb> variance_of_mean, int width,
                              int height);

/// Eq. (1) of |r|^2 pixel by pixel, however it was found. 0 everywhere when all of it is black.
std::vector<double> weights_of_squares(const std::vector<double>& squares);

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
