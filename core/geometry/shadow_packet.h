// Sixteen shadow rays at once.
#pragma once

#include <concepts>
#include <cstdint>

#include "core/geometry/shadow_segment.h"

namespace mote::core {

/// Sixteen shadow rays as a structure of arrays, in Embree's own layout. Inactive lanes have t_max < t_min.
/// After they were traced an occluded lane has t_max = -infinity.
struct alignas(64) ShadowPacket {
    static constexpr int width = 16;                          ///< lanes
    float origin_x[width], origin_y[width], origin_z[width];  ///< of the segments [m]
    float t_min[width];  ///< where the segment begins, in lengths of its direction
    float direction_x[width], direction_y[width], direction_z[width];  ///< need not have unit length
    float time[width];                                                 ///< of Embree's, 0
    float t_max[width];          ///< where it ends; -infinity: something is in the way
    std::uint32_t mask[width];   ///< of Embree's, all bits set
    std::uint32_t id[width];     ///< of the lane
    std::uint32_t flags[width];  ///< of Embree's, 0

    /// Sets what the caller never needs to touch again (time, mask, id, flags).
    void clear() {
        for (int lane = 0; lane < width; ++lane)
            time[lane] = 0.0f, mask[lane] = 0xffffffffu, id[lane] = std::uint32_t(lane), flags[lane] = 0;
    }
    /// A lane's segment: origin [m], direction of any length, and its end in lengths of the direction.
    template <std::integral Lane>
    void set(Lane lane, const Vec3& origin, const Vec3& direction, float end) {
        origin_x[lane] = origin.x, origin_y[lane] = origin.y, origin_z[lane] = origin.z;
        direction_x[lane] = direction.x, direction_y[lane] = direction.y, direction_z[lane] = direction.z;
        t_min[lane] = 0.0f, t_max[lane] = end;
    }
    /// A lane's segment between two points [m], up to the surface at its end.
    template <std::integral Lane>
    void set_segment(Lane lane, const Vec3& from, const Vec3& to) {
        const Vec3 segment = to - from;
        set(lane, from, segment, shadow_fraction(from, 1.0f / glm::length(segment)));
    }
    template <std::integral Lane>
    Vec3 origin(Lane lane) const {
        return {origin_x[lane], origin_y[lane], origin_z[lane]};  ///< [m]
    }
    template <std::integral Lane>
    Vec3 direction(Lane lane) const {
        return {direction_x[lane], direction_y[lane], direction_z[lane]};  ///< of any length
    }
    /// After it was traced: is something in the way?
    bool occluded(int lane) const { return t_max[lane] < 0.0f; }
};

}  // namespace mote::core
