// Sixteen shadow rays at once.
#pragma once

#include <cstdint>

namespace mote::core {

/// Sixteen shadow rays as a structure of arrays, in Embree's own layout. Inactive lanes have t_max < t_min.
/// After they were traced an occluded lane has t_max = -infinity.
struct alignas(64) ShadowPacket {
    static constexpr int width = 16;
    float origin_x[width], origin_y[width], origin_z[width];
    float t_min[width];
    float direction_x[width], direction_y[width], direction_z[width];  ///< need not have unit length
    float time[width];
    float t_max[width];
    std::uint32_t mask[width];
    std::uint32_t id[width];
    std::uint32_t flags[width];

    /// Sets what the caller never needs to touch again (time, mask, id, flags).
    void clear() {
        for (int lane = 0; lane < width; ++lane)
            time[lane] = 0.0f, mask[lane] = 0xffffffffu, id[lane] = std::uint32_t(lane), flags[lane] = 0;
    }
    bool occluded(int lane) const { return t_max[lane] < 0.0f; }
};

}  // namespace mote::core
