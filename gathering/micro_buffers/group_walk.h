// One walk down a point hierarchy for a group of receivers, side by side in vector registers.
#pragma once

#include "gathering/micro_buffers/disc_raster.h"
#include "gathering/micro_buffers/micro_buffers.h"

namespace mote::gathering {

/// What receivers of a group need to decide and to project, a lane each.
struct alignas(64) ReceiverLanes {
    static constexpr std::uint32_t width = 8;
    float x[width], y[width], z[width];  ///< positions [m]
    float s[3][width], t[3][width], n[3][width];
    /// Leaves before this one a lane takes no part in: it has dealt with a node above them.
    std::uint32_t wake[width];
};

/// Fills the buffers of at most ReceiverLanes::width receivers, each of them the same whoever is in the
/// group. distances and hits hold `stride` entries a receiver, and are cleared.
void walk_group(const PointHierarchy& hierarchy, const MicroBufferSettings& settings,
                const RayDirections& rays, std::span<const MicroReceiver> receivers, std::size_t stride,
                float* distances, std::uint32_t* hits);

}  // namespace mote::gathering
