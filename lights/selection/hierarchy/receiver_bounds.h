// Bounds of sixteen receivers, or of sixteen clusters of receivers: the receiver's end of a bound.
#pragma once

#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

/// Each lane is a receiver or a cluster of them.
struct alignas(64) ReceiverBounds {
    static constexpr int width = ReceiverLanes::width;

    float lower_x[width], lower_y[width], lower_z[width];  ///< positions
    float upper_x[width], upper_y[width], upper_z[width];
    /// A cone: on surfaces of normals, where they reflect on one side only; of the preferred directions of
    /// Henyey-Greenstein's function. cos = -1: of everything.
    float axis_x[width], axis_y[width], axis_z[width], cos_angle[width], sin_angle[width];
    float has_cosine[width];  ///< 1: C* of this end is the cosine to a direction of the cone; 0: it is 1
    /// |g| of the function; both 0 where f* is constant.
    float g_low[width], g_high[width];
    /// Throughput times f*, or times the upper bound of f* where it has no lobe here; for
    /// Henyey-Greenstein times 1 / 4 pi.
    float weight_r[width], weight_g[width], weight_b[width];
    std::int32_t max_vpl_depth[width];  ///< 0: an idle lane, and its weights are 0
    /// Set where eval_bound() gives f* for every cluster of VPLs, and the weights do not hold it.
    const core::ScatteringVertex* glossy[width];
    bool any_lobe = false, any_glossy = false, any_active = false;

    /// Receivers of a tile. Vertices must outlive it.
    explicit ReceiverBounds(const ReceiverLanes& receivers);
    /// Union, lane by lane.
    ReceiverBounds(const ReceiverBounds& a, const ReceiverBounds& b);

    float weight(int i) const { return (weight_r[i] + weight_g[i] + weight_b[i]) * (1.0f / 3.0f); }
    core::DirectionCone cone(int i) const;
    /// Square of the longest diagonal of any lane's positions.
    float diagonal2() const;

  private:
    ReceiverBounds() = default;
    void set_idle(int i);
    void set_vertex(int i, const core::ScatteringVertex& vertex);
    void set_cone(int i, const core::DirectionCone& cone);
    core::Rgb most(int i) const;
    void unite(int i, const ReceiverBounds& a, const ReceiverBounds& b);
};

}  // namespace mote::lights
