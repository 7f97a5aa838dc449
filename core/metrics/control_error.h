// The error of an image of any method, from control passes of an unbiased one at a random subset of pixels.
//
// One pixel is sampled in each block of pixels. a and b are the means of two independent halves of its
// control passes, f is what the image shows there, mu the light. Whatever f is, biased, filtered, or with
// noise that pixels share, the control passes know nothing of it, so that
//
//   E <f - a, f - b> = |f - mu|^2,                                                                     (1)
//
// and with the number k_i of pixels in the block of sample i, n samples and the weights w of Eq. (1) of
// relative_error.h
//
//   error^2 sum w |r|^2 = X +- 1.96 s,   X = sum_i x_i,   x_i = k_i w_i <f_i - a_i, f_i - b_i>, (2) s^2 = n /
//   (2 (n - 1)) sum_i (x_{i+1} - x_i)^2,                                                      (3)
//
// the variance of a stratified sample from successive differences, which has the noise of the control passes
// in it and that of the choice of pixels.
//
// The light that weights are relative to is the image's, scaled so that it is as bright as the control passes
// at the sampled pixels: light that a bound removes would be missing in the norm as well.
#pragma once

#include <cstddef>
#include <span>

#include "core/metrics/halves_error.h"

namespace mote::core {

/// A sampled pixel.
struct ControlSample {
    std::size_t pixel = 0;  ///< index in the image
    double pixels = 0.0;    ///< number in its block
    Rgb a, b;               ///< means of the control passes' halves
};

/// Fewer samples say too little about their spread: no error is stated.
inline constexpr std::size_t min_control_samples = 30;

/// Brightness of the control passes over that of the image, at the samples; 1 where either is black.
double control_scale(std::span<const Rgb> image, const RelativeWeights& weights,
                     std::span<const ControlSample> samples);

/// `samples`: in an order in which neighbours of the image follow each other. `weights`: of the image, scaled
/// by control_scale(). Not known with fewer than min_control_samples.
PictureError control_error(std::span<const Rgb> image, const RelativeWeights& weights,
                           std::span<const ControlSample> samples);

}  // namespace mote::core
