// Receivers that outlive the eye paths that made them.
#pragma once

#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

struct RecordedReceivers {
    ReceiverTile tile;

    /// Copies the tile, and the vertices that it refers to.
    void copy(const ReceiverTile& other) {
        tile = other;
        for (int i = 0; i < ReceiverTile::width; ++i)
            if (other.directional[i])
                vertices_[std::size_t(i)] = *other.directional[i],
                tile.directional[i] = &vertices_[std::size_t(i)];
    }

    RecordedReceivers() = default;
    RecordedReceivers(const RecordedReceivers&) = delete;
    RecordedReceivers& operator=(const RecordedReceivers&) = delete;

  private:
    std::array<core::ScatteringVertex, ReceiverTile::width> vertices_;
};

}  // namespace mote::lights
