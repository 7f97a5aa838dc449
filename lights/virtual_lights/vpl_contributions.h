// Unoccluded light of one virtual point light at sixteen receivers.
//
// Engelhardt 2013, Eqs. 10.4 (media) and 10.5 (surfaces), one term of the sum without its visibility:
//   f*(x) w(G*(x,y_j)) I_j
// Where f* is constant at both ends the loop over the lanes is branch-free arithmetic.
#pragma once

#include "core/math/vectorize.h"
#include "lights/virtual_lights/geometry_weights.h"
#include "lights/virtual_lights/virtual_point_light.h"
#include "lights/virtual_lights/vpl_choice.h"
#include "lights/virtual_lights/vpl_receivers.h"

namespace mote::lights {

/// The light of one VPL at sixteen receivers.
struct alignas(64) LaneLight {
    static constexpr int width = ReceiverLanes::width;
    float r[width], g[width], b[width];
    const ReceiverLanes* receivers;
    std::size_t vpl;  ///< its index
};

/// A receiver exactly on a VPL: keeps 1/d^2 finite. Far below any distance that single precision resolves.
inline constexpr float min_distance_squared = 1e-30f;

/// Receivers of constant f* and a plain VPL. Returns whether any lane receives light.
template <typename Weight>
bool plain_contributions(const ReceiverLanes& x, const VirtualPointLight& y, float light_weight,
                         const Weight& weight, core::ShadowPacket& packet, LaneLight& out) {
    const float y_in_medium = y.on_surface() ? 0.0f : 1.0f;
    const float px = y.position.x, py = y.position.y, pz = y.position.z;
    const float nx = y.normal.x, ny = y.normal.y, nz = y.normal.z;
    const float sx = y.shading_normal.x, sy = y.shading_normal.y, sz = y.shading_normal.z;
    const core::Rgb intensity = y.intensity * light_weight;  // I_j, Eq. 10.3
    const float ir = intensity.x, ig = intensity.y, ib = intensity.z;
    const auto depth = std::int32_t(y.depth);
    const Weight own_weight = weight;  // a copy: its members are no loads within the loop
    float brightest = 0.0f;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        const float dx = px - x.x[i], dy = py - x.y[i], dz = pz - x.z[i];
        const float d2 = core::max_of(dx * dx + dy * dy + dz * dz, min_distance_squared);
        const float inv_d = 1.0f / std::sqrt(d2);
        const float side_x = dx * x.geometric_x[i] + dy * x.geometric_y[i] + dz * x.geometric_z[i];
        const float cos_x = dx * x.shading_x[i] + dy * x.shading_y[i] + dz * x.shading_z[i];
        const float cos_y = -(dx * nx + dy * ny + dz * nz);
        const float side_y = -(dx * sx + dy * sy + dz * sz);
        // C* is the positive cosine on a surface and 1 in a medium; both sides of a shading normal must
        // agree.
        const float c_x = core::min_of(side_x, cos_x) > 0.0f ? cos_x * inv_d : x.in_medium[i];
        const float c_y = core::min_of(side_y, cos_y) > 0.0f ? cos_y * inv_d : y_in_medium;
        const float g = c_x * c_y * (inv_d * inv_d);  // G* = C* C* / d^2
        const float weighted_g = weighted_geometry(own_weight, g, d2, c_x, c_y, i);
        const float weighted = depth <= x.max_vpl_depth[i] ? weighted_g : 0.0f;
        // f* w(G*) I_j of Eqs. 10.4 and 10.5
        const float r = x.weight_r[i] * ir * weighted;
        const float gr = x.weight_g[i] * ig * weighted;
        const float b = x.weight_b[i] * ib * weighted;
        out.r[i] = r, out.g[i] = gr, out.b[i] = b;
        const float lit = core::max_of(r, core::max_of(gr, b));
        const float end = core::shadow_fraction(x.position(i), inv_d);
        packet.set(i, x.position(i), {dx, dy, dz}, lit > 0.0f ? end : -1.0f);
    }
    for (int i = 0; i < ReceiverLanes::width; ++i) brightest = core::max_of(brightest, packet.t_max[i]);
    return brightest > 0.0f;
}

/// One lane of the general case, where f* of either end depends on direction: f* I_j and what the weight
/// needs.
struct LaneConnection {
    core::Rgb value;  ///< f* I_j
    float distance_squared, cos_x, cos_y;
    core::Vec3 origin, target;  ///< of the shadow ray
};
/// `light_weight` is in the value.
LaneConnection lane_connection(const ReceiverLanes& x, int lane, const VplSet& vpls,
                               const VirtualPointLight& y, float light_weight);

template <typename Weight>
bool general_contributions(const ReceiverLanes& x, const VplSet& vpls, const VirtualPointLight& y,
                           float light_weight, const Weight& weight, core::ShadowPacket& packet,
                           LaneLight& out) {
    bool any = false;
    for (int i = 0; i < ReceiverLanes::width; ++i) {
        out.r[i] = out.g[i] = out.b[i] = 0.0f;
        packet.t_max[i] = -1.0f;
        if (std::int32_t(y.depth) > x.max_vpl_depth[i]) continue;
        const LaneConnection c = lane_connection(x, i, vpls, y, light_weight);
        const float g = c.cos_x * c.cos_y / c.distance_squared;
        const core::Rgb value =
            c.value * weighted_geometry(weight, g, c.distance_squared, c.cos_x, c.cos_y, i);
        if (!(core::max_component(value) > 0.0f)) continue;
        out.r[i] = value.x, out.g[i] = value.y, out.b[i] = value.z;
        packet.set_segment(i, c.origin, c.target);
        any = true;
    }
    return any;
}

/// The policy for one light, where it is not the same for all of them.
template <typename Weight>
auto weight_of_pair(const Weight& weight, [[maybe_unused]] const ReceiverLanes& receivers,
                    [[maybe_unused]] const VplSet& vpls, [[maybe_unused]] std::size_t index) {
    if constexpr (requires { weight.for_pair(receivers, vpls, index); })
        return weight.for_pair(receivers, vpls, index);
    else
        return weight;
}

/// Light into `out` and shadow rays into `packet`, which has been cleared once. Returns whether any lane
/// receives light; else nothing of the two counts.
template <typename Weight>
bool contributions_of(const VplSet& vpls, const WeightedVpl& light, const ReceiverLanes& receivers,
                      const Weight& weight, core::ShadowPacket& packet, LaneLight& out) {
    const VirtualPointLight& vpl = vpls.lights[light.index];
    out.receivers = &receivers, out.vpl = light.index;
    const auto own_weight = weight_of_pair(weight, receivers, vpls, light.index);
    if (vpl.detail == VirtualPointLight::no_detail && !receivers.any_directional)
        return plain_contributions(receivers, vpl, light.weight, own_weight, packet, out);
    return general_contributions(receivers, vpls, vpl, light.weight, own_weight, packet, out);
}

}  // namespace mote::lights
