#include "core/film/tiles.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

namespace mote::core {

bool for_each_tile(int width, int height, int tile_size, const std::atomic<bool>& cancelled,
                   const std::function<void(int, int, int, int)>& body) {
    if (tile_size < 1) throw std::invalid_argument("a tile needs at least one pixel");
    const int columns = (width + tile_size - 1) / tile_size, rows = (height + tile_size - 1) / tile_size;
    tbb::parallel_for(0, rows * columns, [&](int tile) {
        if (cancelled.load(std::memory_order_relaxed)) return;
        const int x0 = tile % columns * tile_size, y0 = tile / columns * tile_size;
        body(x0, y0, std::min(x0 + tile_size, width), std::min(y0 + tile_size, height));
    });
    return !cancelled.load(std::memory_order_relaxed);
}

}  // namespace mote::core
