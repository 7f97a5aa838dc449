// The geometry term between receivers and a patch of surface, for a packet of receivers at a time.
//
//   G_r = max(G - b, 0)        Engelhardt 2013, Sec. 11.1.2
//
// G = cos cos' / d^2 grows without limit where a patch of area A all but touches the point. The mean over a
// disc of that area, seen from its axis, is cos cos' / (d^2 + A / pi); with A cos' in place of A it holds for
// patches seen at a slant. Summed over a wall, a receiver half a pixel from the edge gets 1 % too much from
// square patches; by the centres alone it would be 23 %.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/lanes.h"
#include "core/math/vectorize.h"
#include "screenspace/ssbc/mip_pyramid.h"

namespace mote::screenspace {

/// Neighbours share almost all nodes, so a wide packet costs few lanes that compute for nothing.
inline constexpr std::size_t packet_size = core::Lanes::width;

/// A point that light is gathered at.
struct SsbcReceiver {
    core::Vec3 position, normal;
    float size;  ///< root of the area of its patch [m]; no other patch comes nearer than a tenth of it
};

/// Receivers side by side, so that the compiler makes vector instructions of loops over them.
struct ReceiverPacket {
    core::Lanes px, py, pz, nx, ny, nz, size;
    core::Bounds3 bounds;
    void set(std::size_t lane, const SsbcReceiver& r) {
        px[lane] = r.position.x, py[lane] = r.position.y, pz[lane] = r.position.z;
        nx[lane] = r.normal.x, ny[lane] = r.normal.y, nz[lane] = r.normal.z;
        size[lane] = r.size;
        bounds.extend(r.position);
    }
};

/// G_r = max(G - b, 0) of Eq. 11.5, its mean over a patch [1/m^2].
inline void residual_of(const ReceiverPacket& r, const SurfaceNode& node, float bound,
                        core::Lanes& residual) {
    const core::Vec3 p = node.position, n = node.normal;
    const float disc = node.area * core::inv_pi;
    MOTE_INDEPENDENT_LANES
    for (std::size_t l = 0; l < packet_size; ++l) {
        const float dx = p.x - r.px[l], dy = p.y - r.py[l], dz = p.z - r.pz[l];
        // Where they coincide every cosine is zero: so is the result.
        const float d2 = std::max(dx * dx + dy * dy + dz * dz, 1e-30f), inv_d = 1.0f / std::sqrt(d2);
        const float at_receiver = std::max(0.0f, (dx * r.nx[l] + dy * r.ny[l] + dz * r.nz[l]) * inv_d);
        const float at_node = std::max(0.0f, -(dx * n.x + dy * n.y + dz * n.z) * inv_d);
        residual[l] = std::max(at_receiver * at_node / (d2 + disc * at_node) - bound, 0.0f);
    }
}

/// Upper bound of G between the receivers and any pixel of a node [1/m^2].
inline void largest_geometry_term(const ReceiverPacket& r, const SurfaceNode& node, bool discontinuity,
                                  core::Lanes& largest) {
    const core::Vec3 p = node.position, n = node.normal;
    const float radius = node.radius, thickness = node.thickness;
    const float spread = discontinuity ? 1.0f : node.spread;
    MOTE_INDEPENDENT_LANES
    for (std::size_t l = 0; l < packet_size; ++l) {
        const float dx = p.x - r.px[l], dy = p.y - r.py[l], dz = p.z - r.pz[l];
        const float d = std::sqrt(dx * dx + dy * dy + dz * dz);
        const float over_receiver = dx * r.nx[l] + dy * r.ny[l] + dz * r.nz[l];
        const float over_node = -(dx * n.x + dy * n.y + dz * n.z);
        const float aligned = r.nx[l] * n.x + r.ny[l] * n.y + r.nz[l] * n.z;
        const float across = std::sqrt(std::max(0.0f, 1.0f - aligned * aligned));
        const float nearest = std::max(std::max(d - radius, over_node - thickness), 0.1f * r.size[l]);
        const float inv = 1.0f / nearest;
        // The highest point over the receiver's plane: on a disc, as thick as the node.
        const float highest = over_receiver + thickness + radius * across;
        const float at_receiver = std::min(1.0f, std::max(0.0f, highest * inv));
        const float at_node = std::min(1.0f, std::max(0.0f, (over_node + thickness) * inv) + spread);
        largest[l] = at_receiver * at_node * inv * inv;
    }
}

}  // namespace mote::screenspace
