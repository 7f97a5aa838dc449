#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int width = ReceiverLanes::width;

void attenuate(const GatherContext& context, ReceiverTile& tile, const ShadowPacket& packet,
               LaneLight& light) {
    for (int i = 0; i < width; ++i) {
        if (packet.occluded(i)) continue;
        context.cancelled.check();
        const Rgb transmittance = lane_transmittance(context, tile, i, packet);
        light.r[i] *= transmittance.x, light.g[i] *= transmittance.y, light.b[i] *= transmittance.z;
    }
}

}  // namespace

Rgb lane_transmittance(const GatherContext& context, ReceiverTile& tile, int i, const ShadowPacket& packet) {
    const Vec3 from = packet.origin(i);
    const Vec3 to = from + packet.direction(i);
    const ScatteringVertex* v = tile.directional[i];
    const MediumState state = v ? v->state_towards(tile.state[i], to - from) : tile.state[i];
    return context.scene.transmittance(from, to, state, tile.rng[i], context.tracking);
}

std::uint64_t count_rays(std::span<const ShadowPacket> packets) {
    std::uint64_t rays = 0;
    for (const ShadowPacket& packet : packets) {
        int active = 0;
        for (int i = 0; i < width; ++i) active += packet.t_max[i] > 0.0f ? 1 : 0;
        rays += std::uint64_t(active);
    }
    return rays;
}

void attenuate_free(const GatherContext& context, ReceiverTile& tile, std::span<const ShadowPacket> packets,
                    std::span<LaneLight> light) {
    const bool attenuates = context.scene.attenuates();
    for (std::size_t p = 0; p < packets.size(); ++p) {
        const ShadowPacket& packet = packets[p];
        LaneLight& l = light[p];
        for (int i = 0; i < width; ++i) {
            const bool free =
                packet.t_max[i] >= 0.0f;  // of a lane without light it was negative from the start
            l.r[i] = free ? l.r[i] : 0.0f, l.g[i] = free ? l.g[i] : 0.0f, l.b[i] = free ? l.b[i] : 0.0f;
        }
        if (attenuates) attenuate(context, tile, packet, l);
    }
}

void TracedVisibility::operator()(std::span<ShadowPacket> packets, std::span<LaneLight> light) {
    context_.cancelled.check();
    context_.rays.occlusion += count_rays(packets);
    context_.scene.find_occluded(packets);
    attenuate_free(context_, tile_, packets, light);
}

template TileLight gather(const GatherContext&, const VplSet&, const VplRange&, const BoundedGeometry&,
                          ReceiverTile&);

}  // namespace mote::lights
