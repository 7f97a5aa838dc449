// The pixels around a pixel that weights of errors are found from.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/math/vec.h"

namespace mote::core {

/// Calls visit(index) for the 5 x 5 pixels around (x, y), itself included, row by row; at the borders for
/// those of them that there are.
template <typename Visit>
void for_each_near(int x, int y, int width, int height, const Visit& visit) {
    constexpr int reach = 2;
    for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
        for (int u = std::max(0, x - reach); u <= std::min(width - 1, x + reach); ++u)
            visit(std::size_t(v) * std::size_t(width) + std::size_t(u));
}

/// Those of the 5 x 5 pixels around (x, y), without itself, that differ from it by three standard deviations
/// or less.
struct AlikeNeighbours {
    glm::dvec3 sum{0.0};
    double count = 0.0;
};
/// `variance`: of the picture, a value a channel.
AlikeNeighbours alike_neighbours(std::span<const Rgb> picture, std::span<const Rgb> variance, int x, int y,
                                 int width, int height);

}  // namespace mote::core
