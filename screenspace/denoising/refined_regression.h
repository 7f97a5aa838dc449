// Regression in smaller blocks, where what they find beyond larger ones is more than noise.
//
// A block of n pixels fits p numbers, so its fit has p / n of the variance of the colours. The fits of blocks
// of 16 and of 8 pixels follow shadows, caustics and what mirrors show better than those of 32, and carry 4
// and 16 times their noise. Over a window, with the residual of the smaller blocks for the variance,
//   g = max(0, 1 - k (p / n) mean |b - fine|^2 (n / (n - p)) / mean |fine - coarse|^2) (1)
// is how much of the difference is kept: coarse + g (fine - coarse), from one size to the next.
#pragma once

#include "screenspace/denoising/block_regression.h"

namespace mote::screenspace {

/// k of Eq. (1): differences below that many times the noise are noise.
inline constexpr float refinement_confidence = 2.0f;

/// block_regression() with blocks of settings.block, refined down to blocks of `finest` pixels.
Regression refined_regression(int width, int height, std::span<const FeaturePlane> features,
                              std::span<const core::Rgb> colour, const RegressionSettings& settings,
                              int finest = 8, core::CancelToken cancelled = {});

}  // namespace mote::screenspace
