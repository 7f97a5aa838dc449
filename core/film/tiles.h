// The loop over the tiles of a picture.
#pragma once

#include <atomic>
#include <functional>

namespace mote::core {

/// Runs `body(x0, y0, x1, y1)` over tiles of the picture in parallel, until done or cancelled. Returns false
/// when cancelled. The order of tiles must not matter to the result.
bool for_each_tile(int width, int height, int tile_size, const std::atomic<bool>& cancelled,
                   const std::function<void(int, int, int, int)>& body);

}  // namespace mote::core
