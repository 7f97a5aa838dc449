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
// Weights are relative to the light, of which a biased image misses some, and in some places more than in
// others: the image's is scaled block by block so that it is as bright as the control passes in the 5 x 5
// blocks around, without the block itself, whose control passes would else err as its weight does.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/metrics/halves_error.h"

namespace mote::core {

/// Size of a block [pixels].
inline constexpr int control_block_width = 4, control_block_height = 2;

/// The sampled pixel of a block.
struct ControlSample {
    std::size_t pixel = 0;  ///< index in the image
    double pixels = 0.0;    ///< number in its block
    Rgb a, b;               ///< means of the control passes' halves
};
/// Samples of all blocks, row by row.
struct ControlSamples {
    int columns = 0, rows = 0;  ///< numbers of blocks
    std::vector<ControlSample> blocks;
};

/// Fewer samples say too little about their spread: no error is stated.
inline constexpr std::size_t min_control_samples = 30;

/// Weights of an image as bright as the control passes, from `weights`, its own; `width`: of the image.
RelativeWeights control_weights(std::span<const Rgb> image, const RelativeWeights& weights,
                                const ControlSamples& samples, int width);

/// `weights`: control_weights(). Not known with fewer than min_control_samples.
PictureError control_error(std::span<const Rgb> image, const RelativeWeights& weights,
                           const ControlSamples& samples);

}  // namespace mote::core
