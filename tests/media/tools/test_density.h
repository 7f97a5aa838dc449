// The density that test grids hold at integer positions 0..23 of each axis: a lump with ripples, 0 at the
// border.
#pragma once

#include <cmath>

namespace mote::tests {

inline constexpr int test_grid_size = 24;

inline float test_density(int x, int y, int z) {
    const double dx = x - 11.0, dy = y - 12.0, dz = z - 11.5;
    const double lump = 3.0 * std::exp(-(dx * dx + 1.3 * dy * dy + 0.8 * dz * dz) / 30.0) - 0.02;
    const double ripples = 1.0 + 0.5 * std::sin(1.1 * x) * std::cos(0.9 * y + 0.4 * z);
    return lump > 0.0 ? float(lump * ripples) : 0.0f;
}

}  // namespace mote::tests
