// Radii of kernels that shrink from pass to pass, so that the mean over passes loses both bias and noise.
//
// Knaus & Zwicker 2011 (after Hachisuka et al. 2008):  r_{i+1}^d / r_i^d = (i + alpha) / (i + 1) for kernels
// of d dimensions, i = 1, 2, ... Passes are independent: the product up to pass i is a quotient of
// Gamma functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace mote::gathering {

/// Radius of pass `pass` (from 0) over that of pass 0. `alpha` in (0, 1]: 1 does not shrink.
inline double radius_fraction(std::uint32_t pass, double alpha, int dimensions = 2) {
    const double i = double(pass);
    // product over j = 1 .. pass of (j + alpha) / (j + 1)
    const double log_product =
        std::lgamma(i + 1.0 + alpha) - std::lgamma(1.0 + alpha) - (std::lgamma(i + 2.0) - std::lgamma(2.0));
    return std::exp(log_product / double(dimensions));
}

/// Radius for `paths` light paths over that for up to `few`: so many merges a query, however many there are.
inline double radius_for_paths(double paths, double few, int dimensions) {
    return paths > few ? std::pow(few / paths, 1.0 / double(dimensions)) : 1.0;
}

}  // namespace mote::gathering
