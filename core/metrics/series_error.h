// Errors of many pictures against the same references: each by itself, and several of one method together.
//
// With the weights w of relative_error.h, for a pair a, b those of its mean, and n independent pictures x_i,
// which differ in their seeds:
//
//   norm          = sum w <a, b>
//   error_i^2     = sum w <x_i - a, x_i - b> / norm                                           (1)
//   bias_i        = sum w (<a, x_i - b> + <b, x_i - a>) / 2 / norm                            (2)
//   systematic^2  = mean over i < j of sum w (<x_i - a, x_j - b> + <x_j - a, x_i - b>) / 2 / norm   (3)
//   noise^2       = mean of error_i^2 - systematic^2                                          (4)
//
// in expectation free of the references' noise, and (3) of the pictures' as well. For one reference r, a = b
// = r, and where its variance v is known sum w v is subtracted from (1) and (3).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/metrics/reference_pair.h"

namespace mote::core {

/// Errors of one method; all NaN where the references are black. Standard errors are NaN where they are not
/// known.
struct SeriesError {
    double squared_error = 0.0;         ///< mean of Eq. (1) over the pictures; below 0 where noise hides it
    double error = 0.0;                 ///< its root, 0 where it is negative: the error of one picture
    double error_standard_error = 0.0;  ///< from the spread of pictures; of one picture, from that of pixels
    double bias = 0.0;                  ///< mean of Eq. (2)
    double bias_standard_error = 0.0;   ///< likewise
    double systematic = 0.0;            ///< root of Eq. (3); NaN for one picture
    double systematic_standard_error = 0.0;  ///< from the spread of pixels
    double noise = 0.0;                      ///< root of Eq. (4), of one picture; NaN for one picture
};

/// One reference, or two of different seeds, with the weights of their pixels.
class ErrorMeasure {
  public:
    /// `counted`: pixels that count, those not 0; empty for all. Weights are found before pixels are left
    /// out, but values that are not finite are taken for black there. `variance`, of the mean, may be empty.
    /// All counted values must be finite. Throws std::invalid_argument when a size does not fit.
    ErrorMeasure(std::span<const Rgb> reference, std::span<const Rgb> variance, int width, int height,
                 std::span<const std::uint8_t> counted = {});
    ErrorMeasure(const ReferencePair& pair, int width, int height,
                 std::span<const std::uint8_t> counted = {});

    /// Eq. (1) by pixel: those that count have error^2 for their mean, all others are 0. Throws
    /// std::invalid_argument when the size does not fit.
    std::vector<double> pixel_errors(std::span<const Rgb> image) const;
    /// Throws std::invalid_argument when a size does not fit, or without pictures.
    SeriesError measure(std::span<const std::vector<Rgb>> images) const;

  private:
    void count(std::span<const std::uint8_t> counted);
    /// w (<x - a, y - b> + <y - a, x - b>) / 2 at pixel p, less w v.
    double product(std::span<const Rgb> x, std::span<const Rgb> y, std::size_t p) const;
    /// w (<a, x - b> + <b, x - a>) / 2 at pixel p.
    double bias_at(std::span<const Rgb> x, std::size_t p) const;

    std::vector<Rgb> a_, b_;
    std::vector<double> weight_, subtracted_;  ///< subtracted_: v, averaged over channels
    double norm_ = 0.0;
    std::size_t counted_ = 0;
};

}  // namespace mote::core
