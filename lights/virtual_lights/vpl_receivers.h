// Sixteen receivers of virtual point lights: the first connectable vertices of a 4x4 tile of pixels, on
// surfaces and in media mixed.
//
// f* of a diffuse surface and of an isotropic medium is a constant and goes to the lane's weight; of
// everything else the vertex is kept.
#pragma once

#include "core/scene/scattering_vertex.h"

namespace mote::lights {

/// Positions and BSDFs of sixteen receivers: all that a connection needs but its visibility.
struct alignas(64) ReceiverLanes {
    static constexpr int width = core::ShadowPacket::width;  ///< lanes

    // Position moved off the surface towards the viewer: the start of shadow rays.
    float x[width] = {}, y[width] = {}, z[width] = {};
    // Shading and geometric normal on the viewer's side; zero in a medium.
    float shading_x[width] = {}, shading_y[width] = {}, shading_z[width] = {};
    float geometric_x[width] = {}, geometric_y[width] = {}, geometric_z[width] = {};
    float in_medium[width] = {};  ///< 1 in a medium, else 0
    // Path throughput, times f* where that is a constant.
    float weight_r[width] = {}, weight_g[width] = {}, weight_b[width] = {};
    std::int32_t max_vpl_depth[width] = {};  ///< VPLs deeper than this are left out; 0 for an idle lane

    const core::ScatteringVertex* directional[width] = {};  ///< set where f* depends on direction
    bool any_directional = false;                           ///< true where one of them is set
    bool any_active = false;                                ///< true where a lane is not idle

    core::Vec3 position(int i) const { return {x[i], y[i], z[i]}; }  ///< of a lane [m]
    /// Geometric normal of a lane, unit or zero.
    core::Vec3 geometric_normal(int i) const { return {geometric_x[i], geometric_y[i], geometric_z[i]}; }
};

/// Receivers with the media around them.
struct alignas(64) ReceiverTile : ReceiverLanes {
    core::MediumState state[width];  ///< media at the receiver
    core::Rng rng[width];            ///< for transmittance estimates

    /// Fills a lane. `throughput` is the weight of the eye path; `vertex` must outlive the tile when f*
    /// depends on direction.
    void set(int lane, const core::ScatteringVertex& vertex, const core::Rgb& throughput,
             const core::MediumState& medium_state, const core::Rng& tracking_rng, std::int32_t max_depth);
    /// All lanes idle.
    void clear();
};

}  // namespace mote::lights
