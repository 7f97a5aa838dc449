// Importance of a light for sixteen receivers, by which connections are sampled (line_candidates.h).
//
// Lines are cut into three segments. Over a piece of length l, whose ends lie A and B away from a point,
// 1/w^2 is
//   l / (|A| |B|) * angle / sin(angle)
// where the angle is the one between A and B; sqrt(2 / (1 + cos)) replaces angle / sin(angle), and is at
// most 1.6 times too small. The rest of the integrand is what it is in the middle of the piece. Visibility is
// left out, and transmittance falls like a polynomial, not exponentially. It is 0 only where no light can
// arrive at all.
#pragma once

#include "core/math/lanes.h"
#include "lights/ray_lights/line_connections.h"

namespace mote::lights {

/// One segment of each of sixteen eye rays.
struct EyeLines {
    std::array<const EyeLine*, ReceiverLanes::width> of{};  ///< by lane; null: idle
};

/// Number of pieces that the importance of a line is computed from.
inline constexpr int line_segments = 3;

/// Sixteen eye rays, as importance() needs them.
struct EyeReceivers {
    core::Lanes x[line_segments + 1], y[line_segments + 1], z[line_segments + 1];  ///< ends of segments [m]
    core::Lanes
        weight[line_segments];  ///< throughput times what scatters in the middle, times the piece's length
    core::Lanes direction_x, direction_y, direction_z;  ///< unit
    core::Lanes near_squared;                           ///< softening of 1/w^2 [m^2]
    core::Lanes extinction, asymmetry;  ///< between the ray and lights [1/m]; g of the phase function
    std::int32_t max_depth[ReceiverLanes::width] = {};  ///< of lights; 0: idle
    bool directional = false;                           ///< true where a phase function depends on direction

    explicit EyeReceivers(const EyeLines& eyes);  ///< the lines need not outlive it
};

/// Sixteen points, as importance() needs them.
struct PointReceivers {
    const ReceiverLanes& lanes;      ///< positions, normals and BSDFs
    core::Lanes extinction;          ///< around them [1/m]
    float bound;                     ///< of the geometry term [1/m^2]
    core::Lanes weight, all_around;  ///< mean of the channels; 1 where light may come from everywhere, else 0

    /// Keeps a reference to `points`. `extinction`: mean around each of them [1/m].
    PointReceivers(const ReceiverLanes& points, const core::Lanes& extinction, float bound);
};

/// Importance of a ray light for each lane.
void importance(const RayLight& light, const EyeReceivers& eyes, core::Lanes& out);
void importance(const RayLight& light, const PointReceivers& points, core::Lanes& out);
/// Importance of a VPL on a surface for each lane.
void importance(const VirtualPointLight& vpl, const EyeReceivers& eyes, core::Lanes& out);
void importance(const VirtualPointLight& vpl, const PointReceivers& points, core::Lanes& out);

}  // namespace mote::lights
