// One walk down a point hierarchy for a group of receivers, side by side in vector registers.
#pragma once

#include "gathering/micro_buffers/disc_raster.h"
#include "gathering/micro_buffers/micro_buffers.h"

namespace mote::gathering {

/// Positions and frames of the receivers of a group, a lane each.
struct alignas(64) ReceiverLanes {
    static constexpr std::uint32_t width = 8;
    float x[width], y[width], z[width];  ///< positions [m]
    float s[3][width], t[3][width], n[3][width];
    /// First leaf that the lane still takes part in: those before it lie below a node that it has handled.
    std::uint32_t wake[width];
};

/// Fills the buffers of at most ReceiverLanes::width receivers, each of them the same whichever receivers are
/// in the group. distances and hits hold `stride` entries a receiver, and are cleared.
void walk_group(const PointHierarchy& hierarchy, const MicroBufferSettings& settings,
                const RayDirections& rays, std::span<const MicroReceiver> receivers, std::size_t stride,
                float* distances, std::uint32_t* hits);

}  // namespace mote::gathering
