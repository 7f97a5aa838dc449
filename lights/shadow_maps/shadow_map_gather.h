// Gathering by shadow maps: receivers are stored first, then lights come one after the other with their maps
// and add to all of them. The other way round than a tile that evaluates all lights, because a map pays when
// many receivers read it while it is there; the loop is the same (virtual_lights/vpl_gather.h).
#pragma once

#include <deque>
#include <span>

#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// The receivers of a part of the picture, filled by one task.
class ReceiverStore {
  public:
    /// Sixteen receivers and where they are seen.
    struct Tile : ReceiverLanes {
        std::int32_t column, row;  ///< pixel of the first lane; lanes continue in rows of four
        std::int32_t spacing;      ///< pixels from lane to lane
        VplRange range;            ///< the VPLs that they gather
    };

    /// Keeps receivers whose light counts `scale` times. Copies what they point to.
    void add(const ReceiverLanes& receivers, int column, int row, int spacing, const VplRange& range,
             float scale);
    /// Forgets all tiles and keeps the memory.
    void clear();

    const std::vector<Tile>& tiles() const { return tiles_; }  ///< in the order in which they were added
    std::size_t receivers() const { return receivers_; }       ///< lanes that are not idle
    /// Memory of the tiles [B].
    std::size_t memory_bytes() const {
        return tiles_.capacity() * sizeof(Tile) + vertices_.size() * sizeof(core::ScatteringVertex);
    }

  private:
    std::vector<Tile> tiles_;
    std::deque<core::ScatteringVertex> vertices_;  ///< addresses stay
    std::size_t receivers_ = 0;
};

/// A VPL and the map of what it sees, or of one side of it.
struct MappedVpl {
    std::size_t index;               ///< of the light
    const VolumetricShadowMap* map;  ///< of what it sees
};

/// The views that hold all light of a VPL: one, or two where it shines to both sides of a surface.
struct VplViews {
    std::array<ShadowMapView, 2> view;  ///< of which the first `count` are used
    int count;                          ///< 1 or 2
};
/// The views of a light whose maps have `size`^2 texels.
VplViews views_of(const VplSet& vpls, std::size_t index, int size);

/// V* from the map of the one light that is gathered.
class MappedVisibility {
  public:
    /// Keeps a reference to the map.
    explicit MappedVisibility(const VolumetricShadowMap& map) : map_(map) {}
    /// As gather_pairs() calls it.
    void operator()(std::span<core::ShadowPacket> packets, std::span<LaneLight> light);
    std::uint64_t lookups() const { return lookups_; }  ///< in the map, so far

  private:
    const VolumetricShadowMap& map_;
    std::uint64_t lookups_ = 0;
};

/// Adds the light of VPLs to stored receivers; one a thread.
class ShadowMapGather {
  public:
    /// `add(tile, lane, light)` is called for every receiver and VPL with light, in the order of `lights`.
    template <typename Weight, typename Add>
    void run(const ReceiverStore& store, const VplSet& vpls, const Weight& weight,
             std::span<const MappedVpl> lights, const Add& add) {
        for (const MappedVpl& light : lights) {
            const auto pairs = [&](const auto& visit) {
                for (const ReceiverStore::Tile& tile : store.tiles())
                    if (tile.range.contains(light.index)) visit(tile, WeightedVpl{light.index});
            };
            MappedVisibility visibility(*light.map);
            gather_pairs(vpls, pairs, weight, visibility, scratch_, [&](const LaneLight& l) {
                const auto& tile = static_cast<const ReceiverStore::Tile&>(*l.receivers);
                for (int i = 0; i < ReceiverLanes::width; ++i)
                    if (const core::Rgb value(l.r[i], l.g[i], l.b[i]); !core::is_black(value))
                        add(tile, i, value);
            });
            lookups_ += visibility.lookups();
        }
    }
    std::uint64_t lookups() const { return lookups_; }  ///< in maps, so far

  private:
    GatherScratch scratch_;
    std::uint64_t lookups_ = 0;
};

}  // namespace mote::lights
