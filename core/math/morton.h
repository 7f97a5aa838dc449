// The order of points along a Morton curve: what is near on the curve is near in space.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/bounds.h"

namespace mote::core {

/// 21 bits of x, each followed by two zeros.
inline std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32) & 0x001f00000000ffffull, x = (x | x << 16) & 0x001f0000ff0000ffull;
    x = (x | x << 8) & 0x100f00f00f00f00full, x = (x | x << 4) & 0x10c30c30c30c30c3ull;
    return (x | x << 2) & 0x1249249249249249ull;
}

/// Place of p on the curve through a cube around the box: 21 bits an axis. Points outside of the box count as
/// on its border.
inline std::uint64_t morton_code(const Vec3& p, const Bounds3& bounds) {
    const double scale = 2097151.0 / std::max(double(max_component(bounds.diagonal())), 1e-30);
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double cell = (double(p[axis]) - double(bounds.lower[axis])) * scale;
        code |= spread_bits(std::uint64_t(std::clamp(cell, 0.0, 2097151.0))) << (2 - axis);
    }
    return code;
}

}  // namespace mote::core
