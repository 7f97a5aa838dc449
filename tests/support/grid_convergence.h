// How far a result on pixels of size h may be from its limit, found by results on pixels of 4h, 2h and h.
//
// For an error C h^p the differences d = |f(2h) - f(h)| and |f(4h) - f(2h)| determine p, and d / (2^p - 1) is
// the error at h. The grid convergence index takes 1.25 times that where three grids are at hand (Roache
// 1994). p is not taken above what theory promises, nor below what it allows: two differences alone determine
// it badly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace mote::tests {

/// `results`: on grids of spacing 4h, 2h and h. The order of the error lies between these two.
inline double grid_convergence_index(const std::array<double, 3>& results, double lowest_order,
                                     double highest_order) {
    const double coarse = std::abs(results[1] - results[0]), fine = std::abs(results[2] - results[1]);
    const double observed = fine > 0.0 ? std::log2(coarse / fine) : highest_order;
    const double ratio = std::exp2(std::clamp(observed, lowest_order, highest_order));
    return 1.25 * std::max(fine, coarse / ratio) / (ratio - 1.0);
}

}  // namespace mote::tests
