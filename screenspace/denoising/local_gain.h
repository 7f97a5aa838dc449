// The variance of a mean of passes that depend on each other, from what it would be if they did not.
//
// Passes are Sobol points: where a pixel shows an edge the variance of their mean falls faster than 1/n, and
// where light is scattered often it does not. The gain, variance over that of independent passes, is
// therefore found in windows. With R[k] / 2^k the variance of the mean of 2^k points, constant for
// independent ones, the sums A and B of the halves of a block of 2^K differ by
// (A - B)^2 = 2^(K+1) (R[K-1] - R[K] / 2) on average (sobol_gain.h). If each doubling leaves a fraction r of
// R, that is q times what independent passes would make it, 2^K R[0], with
//
//   q = r^(K-1) (2 - r),                                                                              (1)
//
// which is solved for r. A sum of parts that fall at different rates falls ever slower: the last doubling is
// taken to leave sqrt(r), so that
//
//   R[K] / R[0] = q sqrt(r) / (2 - sqrt(r)).                                                          (2)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::screenspace {

/// (A - B)^2 of each pixel, and its mean if passes were independent.
struct BlockSquares {
    std::span<const float> seen, expected;
};

/// Gain of each pixel, in (0, 1], from blocks of 2^level points. Pixels of a window count by their relative
/// error, light being `mean`; 1 where nothing differs, and everywhere for blocks of fewer than 16 points,
/// whose ratios hardly depend on r beside 1. Throws std::invalid_argument when sizes differ.
std::vector<float> local_gain(int width, int height, std::span<const core::Rgb> mean,
                              const BlockSquares& squares, std::uint32_t level);

/// Eq. (2) for the ratio q in (0, 1]. Needs level > 1.
float gain_of_ratio(float q, std::uint32_t level);

}  // namespace mote::screenspace
