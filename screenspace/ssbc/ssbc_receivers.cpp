#include "screenspace/ssbc/ssbc_receivers.h"

#include <algorithm>
#include <bit>

namespace mote::screenspace {

namespace {

struct Square {
    int x, y, size;
};

}  // namespace

std::vector<std::uint32_t> cells_along_z_curve(int width, int height,
                                               const std::function<bool(int, int)>& wanted) {
    std::vector<std::uint32_t> cells;
    std::vector<Square> stack = {{0, 0, int(std::bit_ceil(unsigned(std::max({width, height, 1}))))}};
    while (!stack.empty()) {
        const auto [x, y, size] = stack.back();
        stack.pop_back();
        if (x >= width || y >= height) continue;
        if (size == 1) {
            if (wanted(x, y)) cells.push_back(std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x));
            continue;
        }
        const int half = size / 2;
        stack.insert(stack.end(),
                     {{x + half, y + half, half}, {x, y + half, half}, {x + half, y, half}, {x, y, half}});
    }
    return cells;
}

std::vector<SsbcReceiver> receivers_at(std::span<const PixelPatch> patches,
                                       std::span<const std::uint32_t> pixels) {
    std::vector<SsbcReceiver> receivers(pixels.size());
    std::transform(pixels.begin(), pixels.end(), receivers.begin(), [&](std::uint32_t pixel) {
        const PixelPatch& p = patches[pixel];
        return SsbcReceiver{p.centre, p.normal, std::sqrt(p.area)};
    });
    return receivers;
}

}  // namespace mote::screenspace
