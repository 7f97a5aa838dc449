#include "screenspace/ssbc/ssbc_visibility.h"

#include "core/scene/ray_queries.h"

namespace mote::screenspace {

using namespace core;

void TracedVisibility::shadow(const ReceiverPacket& r, const SurfaceNode& node, Lanes& residual) const {
    constexpr float off = 0.05f;
    static_assert(packet_size == ShadowPacket::width);
    const Vec3 target = node.position + node.normal * (node.thickness + off * std::sqrt(node.area));
    ShadowPacket packet;
    packet.clear();
    for (std::size_t l = 0; l < packet_size; ++l) {
        const Vec3 normal(r.nx[l], r.ny[l], r.nz[l]);
        const Vec3 origin = Vec3(r.px[l], r.py[l], r.pz[l]) + normal * (off * r.size[l]);
        const Vec3 way = target - origin;
        packet.origin_x[l] = origin.x, packet.origin_y[l] = origin.y, packet.origin_z[l] = origin.z;
        packet.direction_x[l] = way.x, packet.direction_y[l] = way.y, packet.direction_z[l] = way.z;
        packet.t_min[l] = 0.0f, packet.t_max[l] = residual[l] > 0.0f ? 1.0f : -1.0f;
    }
    const auto wanted = residual;
    scene_.find_occluded({&packet, 1});
    for (std::size_t l = 0; l < packet_size; ++l)
        if (wanted[l] > 0.0f && packet.occluded(int(l))) residual[l] = 0.0f;
}

}  // namespace mote::screenspace
