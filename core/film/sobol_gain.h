// Gain of the mean over Sobol points against that over as many independent ones.
//
// 2^k points of an aligned block, scrambled anew in every pixel (Owen 1997), have a mean of the variance
// R[k] / 2^k, where R is constant for independent points and falls for others. The sums over the halves A and
// B of a block of 2^(k+1) show it:
//
//   d[k] = E (A - B)^2 / 2^(k+2) = R[k] - R[k+1] / 2                                              (1)
//
// so R follows from the top down. The top itself is not seen in a single picture, but the trend of d leads
// there (sobol_gain.cpp).
#pragma once

#include <cstdint>
#include <span>

namespace mote::core {

/// Variance of the mean of n >= 2 passes over what their sample variance / n says; 1 for independent ones.
/// `d`: Eq. (1) for k = 0 .. floor(log2 n) - 1, estimated from the floor(n / 2^(k+1)) complete blocks there
/// are, in any unit. `effective_pixels`: how many independent pixels of equal variance would make a pooled
/// d as certain.
double sobol_gain(std::span<const double> d, std::uint32_t n, double effective_pixels);

}  // namespace mote::core
