// The pixels around a pixel that weights of errors are found from.
#pragma once

#include <algorithm>
#include <cstddef>

namespace mote::core {

/// Two estimates differ by three standard deviations or less. `square`: |a - b|^2, a mean over
/// channels like the variances.
inline bool are_alike(double square, double variance_of_a, double variance_of_b) {
    return !(square > 9.0 * (variance_of_a + variance_of_b));
}

/// Calls visit(index) for the 5 x 5 pixels around (x, y), itself included, row by row; at the borders for
/// those of them that there are.
template <typename Visit>
void for_each_near(int x, int y, int width, int height, const Visit& visit) {
    constexpr int reach = 2;
    for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
            visit(std::size_t(v) * std::size_t(width) + std::size_t(u));
}

}  // namespace mote::core
