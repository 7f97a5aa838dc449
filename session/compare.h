// The error of a picture, with what is known of noise on both sides.
#pragma once

#include <optional>

#include "core/metrics/metrics.h"
#include "core/metrics/reference_pair.h"

namespace mote::session {

/// A picture row by row, and the variance of its mean pixel by pixel; empty where that is not known.
struct MeasuredPicture {
    std::span<const core::Rgb> pixels;         ///< radiance [W/(m^2 sr)]
    std::span<const core::Rgb> variance = {};  ///< its square
};

/// Against one reference, or against the mean of two that differ in their seeds: error and bias then hold
/// none of the noise of either. Throws std::invalid_argument when a size does not fit.
core::ImageMetrics measure(const MeasuredPicture& image, const MeasuredPicture& reference, int width,
                           int height);
/// `mean` is that of the pair. Throws likewise.
core::ImageMetrics measure(const MeasuredPicture& image, const core::ReferencePair& references,
                           const core::PairMean& mean, int width, int height);

}  // namespace mote::session
