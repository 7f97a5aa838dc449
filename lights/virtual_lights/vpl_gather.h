// Gathering: the light of virtual point lights at receivers, sixteen at once.
//
// Engelhardt 2013, Eqs. 10.4 and 10.5, whose sum over lights is the one loop here:
//   sum over j of  f*(x) w(G*(x,y_j)) V*(x,y_j) I_j
// Three policies fill it in. Which pairs of receivers and lights meet, and how much each light counts
// (vpl_choice.h): one tile and many lights, or one light and many stored tiles. What becomes of the geometry
// term (geometry_weights.h). And V*, evaluated for a batch of pairs at a time: shadow rays and transmittance
// (TracedVisibility), or a map of what the light sees (shadow_maps/shadow_map_gather.h).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/geometry/ray_counters.h"
#include "core/objects/cancellation.h"
#include "core/scene/ray_queries.h"
#include "lights/virtual_lights/vpl_contributions.h"

namespace mote::lights {

/// Memory that one task reuses between tiles: a batch of lights at receivers, with the rays between them.
struct GatherScratch {
    static constexpr std::size_t batch = 32;        ///< pairs of a light and a tile
    std::array<core::ShadowPacket, batch> packets;  ///< of shadow rays
    std::array<LaneLight, batch> light;             ///< unoccluded

    GatherScratch() {
        for (core::ShadowPacket& packet : packets) packet.clear();
    }
};

/// Calls add(LaneLight) for every pair whose light arrives at a receiver, in the order of the pairs.
/// `pairs(visit)` calls visit(receivers, WeightedVpl). `visibility(packets, light)` multiplies light by V*; a
/// lane without light has t_max < 0.
template <typename Pairs, typename Weight, typename Visibility, typename Add>
void gather_pairs(const VplSet& vpls, const Pairs& pairs, const Weight& weight, Visibility& visibility,
                  GatherScratch& scratch, const Add& add) {
    std::size_t count = 0;
    const auto resolve = [&] {
        const auto light = std::span(scratch.light).first(count);
        if (count > 0) visibility(std::span(scratch.packets).first(count), light);
        for (const LaneLight& l : light) add(l);
        count = 0;
    };
    pairs([&](const ReceiverLanes& receivers, const WeightedVpl& light) {
        count +=
            contributions_of(vpls, light, receivers, weight, scratch.packets[count], scratch.light[count]);
        if (count == GatherScratch::batch) resolve();
    });
    resolve();
}

/// Scene, scratch memory and counters of gathering by rays.
struct GatherContext {
    const core::RayQueries& scene;     ///< occluders and media
    GatherScratch& scratch;            ///< of this task
    core::RayCounters& rays;           ///< counted up
    core::TrackingCounters& tracking;  ///< counted up
    core::CancelToken cancelled = {};  ///< throws Cancelled, a batch at a time
};

/// V* of a batch of pairs.
class BatchVisibility {
  public:
    virtual ~BatchVisibility() = default;
    /// Multiplies light by V*, as gather_pairs() calls it.
    virtual void operator()(std::span<core::ShadowPacket> packets, std::span<LaneLight> light) = 0;
};

/// V* by shadow rays, all of a batch in one call, times an estimate of the transmittance where the scene
/// attenuates light, by the tile's generators.
class TracedVisibility final : public BatchVisibility {
  public:
    /// Keeps references to both.
    TracedVisibility(const GatherContext& context, ReceiverTile& tile) : context_(context), tile_(tile) {}
    void operator()(std::span<core::ShadowPacket> packets, std::span<LaneLight> light) override;

  private:
    const GatherContext& context_;
    ReceiverTile& tile_;
};

/// Number of active segments of the packets.
std::uint64_t count_rays(std::span<const core::ShadowPacket> packets);

/// Takes the light of occluded lanes away, whose t_max is below 0, and of all others what is lost between
/// receiver and light, an estimate that samples from the tile's generators.
void attenuate_free(const GatherContext& context, ReceiverTile& tile,
                    std::span<const core::ShadowPacket> packets, std::span<LaneLight> light);

/// Transmittance of the segment of a lane that is not occluded: an unbiased estimate, by the lane's
/// generator.
core::Rgb lane_transmittance(const GatherContext& context, ReceiverTile& tile, int lane,
                             const core::ShadowPacket& packet);

/// Light by lane.
using TileLight = std::array<core::Rgb, ReceiverLanes::width>;

/// Sixteen sums.
struct alignas(64) TileSum {
    /// By lane.
    float r[ReceiverLanes::width] = {}, g[ReceiverLanes::width] = {}, b[ReceiverLanes::width] = {};

    /// Lane by lane.
    void add(const LaneLight& light) {
        for (int i = 0; i < ReceiverLanes::width; ++i)
            r[i] += light.r[i], g[i] += light.g[i], b[i] += light.b[i];
    }
    /// The sums by lane.
    TileLight value() const {
        TileLight sum;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = {r[i], g[i], b[i]};
        return sum;
    }
};

/// Light of `lights` at the receivers of a tile, by lane, with a visibility of the caller's. Calls
/// record(LaneLight) with the light of each VPL that sends any, in the order of `lights`.
template <typename Lights, typename Weight, typename Visibility, typename Record>
TileLight gather_with(const GatherContext& context, const VplSet& vpls, const Lights& lights,
                      const Weight& weight, ReceiverTile& tile, Visibility& visibility,
                      const Record& record) {
    TileSum sum;
    if (!tile.any_active) return sum.value();
    const auto pairs = [&](const auto& visit) {
        lights.for_each(vpls.lights.size(), [&](const WeightedVpl& light) { visit(tile, light); });
    };
    gather_pairs(vpls, pairs, weight, visibility, context.scratch, [&](const LaneLight& light) {
        sum.add(light);
        record(light);
    });
    return sum.value();
}

/// gather_with() that records nothing.
template <typename Lights, typename Weight, typename Visibility>
TileLight gather_with(const GatherContext& context, const VplSet& vpls, const Lights& lights,
                      const Weight& weight, ReceiverTile& tile, Visibility& visibility) {
    return gather_with(context, vpls, lights, weight, tile, visibility, [](const LaneLight&) {});
}

/// gather_with() by shadow rays.
template <typename Lights, typename Weight>
TileLight gather(const GatherContext& context, const VplSet& vpls, const Lights& lights, const Weight& weight,
                 ReceiverTile& tile) {
    TracedVisibility visibility(context, tile);
    return gather_with(context, vpls, lights, weight, tile, visibility);
}

// Used by all renderers; other policies are compiled where they are named.
extern template TileLight gather(const GatherContext&, const VplSet&, const VplRange&, const BoundedGeometry&,
                                 ReceiverTile&);

}  // namespace mote::lights
