// V* of a gather by imperfect shadow maps: a lookup where there would be a shadow ray, and the transmittance
// as ever.
#pragma once

#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// A visibility policy of gather_pairs(), for the VPLs that `maps` were built of. Samples from the tile's
/// generators where the scene attenuates light.
class ImperfectVisibility final : public BatchVisibility {
  public:
    /// Keeps references to all three.
    ImperfectVisibility(const GatherContext& context, ReceiverTile& tile, const ImperfectShadowMaps& maps)
        : context_(context), tile_(tile), maps_(maps) {}

    /// As gather_pairs() calls it.
    void operator()(std::span<core::ShadowPacket> packets, std::span<LaneLight> light) override {
        context_.cancelled.check();
        alignas(64) float visible[ReceiverLanes::width];
        for (std::size_t p = 0; p < packets.size(); ++p) {
            maps_.look_up(light[p].vpl, *light[p].receivers, visible);
            float* const t_max = packets[p].t_max;
            for (int i = 0; i < ReceiverLanes::width; ++i)
                t_max[i] = visible[i] > 0.0f ? t_max[i] : -core::infinity;
        }
        attenuate_free(context_, tile_, packets, light);
        lookups_ += packets.size() * ReceiverLanes::width;
    }
    std::uint64_t lookups() const { return lookups_; }  ///< in maps, so far

  private:
    const GatherContext& context_;
    ReceiverTile& tile_;
    const ImperfectShadowMaps& maps_;
    std::uint64_t lookups_ = 0;
};

}  // namespace mote::lights
