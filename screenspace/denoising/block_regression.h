// Block-wise multi-order feature regression (Koskela et al. 2019): in every block of 32 x 32 pixels the noisy
// colours become the linear combination of features without noise that is closest to them.
//
//   minimise over x:  sum_p |b_p - sum_k f_pk x_k|^2,     f = (1, normal, position, position^2, ...)      (1)
//
// - Features are centred and scaled to [-1, 1] in each block before they are squared: the same for every unit
//   and place of the scene, and far from overflow. One that does not vary in a block takes no part.
// - Noise is added to features against rank deficiency (a wall's z may be the same as its x), never to
//   colours nor to the 1, and not where the fit is evaluated. Being independent of colours, it does what a
//   ridge of its variance would. It makes fits differ from (1) by about its square.
// - A block that reaches over the border is fitted where it fits into the picture; only its own pixels are
//   set.
// - The sum of a block is kept: the residual is orthogonal to the 1. Where a fit is negative it becomes zero,
//   which adds what it was.
// - Beyond the paper: noise grows with brightness, and in a block that holds a lamp's reflection the error of
//   the bright pixels, spread over the fit, is many times the values of dark ones. Such blocks are solved a
//   second time with weights,
//
//     minimise over x:  sum_p w_p^2 |b_p - sum_k f_pk x_k|^2,     w_p = 1 / (y_p / y + 0.3)              (2)
//
//   y_p being the first fit and y its mean; a factor restores the energy of the block.
// A pixel whose features are not finite (sky) stays as it is; one whose colour is not finite takes the fit.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/cancellation.h"

namespace mote::screenspace {

/// A number for every pixel, row by row from the top.
struct FeaturePlane {
    std::span<const float> values;  ///< by pixel
    bool squared = false;           ///< its square is a feature as well
};

/// Settings of block_regression().
struct RegressionSettings {
    int block = 32;            ///< side [pixels]
    core::Vec2i offset{0, 0};  ///< of the blocks' grid, other ones in every frame
    bool overlapping =
        true;  ///< four grids, half a block apart, weighted by tents: no seams, at four times the cost
    float noise = 1e-2f;        ///< largest, of features in [-1, 1]
    std::uint64_t seed = 0;     ///< of that noise
    bool keep_positive = true;  ///< fits below zero become zero
    bool weighted = true;       ///< uneven blocks by Eq. (2)
};

/// The grid of a frame: a fixed order that covers the block evenly.
core::Vec2i block_offset(int frame, int block = 32);

/// Result of block_regression().
struct Regression {
    std::vector<core::Rgb> colour;  ///< by pixel
    std::uint64_t filled = 0;       ///< pixels that were not finite
};

/// Independent of the number of threads. Throws std::invalid_argument when sizes differ or the picture is
/// empty, and Cancelled.
Regression block_regression(int width, int height, std::span<const FeaturePlane> features,
                            std::span<const core::Rgb> colour, const RegressionSettings& settings,
                            core::CancelToken cancelled = {});

}  // namespace mote::screenspace
