// Gathering by shadow maps: receivers are stored first, then lights come one after the other with their maps
// and add to all of them. The other way round than vpl_gather.h, because a map pays when many receivers look
// at it while it is there.
#pragma once

#include <deque>
#include <span>

#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

/// The receivers of a part of the picture, filled by one task.
class ReceiverStore {
  public:
    struct Tile : ReceiverLanes {
        std::int32_t column, row;  ///< pixel of the first lane; lanes go on in rows of four
        VplRange range;            ///< the VPLs that they look at
    };

    /// Keeps receivers whose light counts `scale` times. Copies what they point to.
    void add(const ReceiverLanes& receivers, int column, int row, const VplRange& range, float scale);
    void clear();

    const std::vector<Tile>& tiles() const { return tiles_; }
    std::size_t receivers() const { return receivers_; }
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
    std::size_t index;
    const VolumetricShadowMap* map;
};

/// The views that hold all light of a VPL: one, or two where it shines to both sides of a surface.
struct VplViews {
    std::array<ShadowMapView, 2> view;
    int count;
};
VplViews views_of(const VplSet& vpls, std::size_t index, int size);

/// Adds the light of VPLs to stored receivers; one a thread.
class ShadowMapGather {
  public:
    /// `add(tile, lane, light)` is called for every receiver and VPL with light, in the order of `lights`.
    template <typename Add>
    void run(const ReceiverStore& store, const VplSet& vpls, float bound, std::span<const MappedVpl> lights,
             Add&& add) {
        for (const MappedVpl& light : lights) {
            look_up(store, vpls, bound, light);
            for (std::size_t k = 0; k < points_.size(); ++k)
                for (int lane = 0; lane < ReceiverLanes::width; ++lane) {
                    const auto& c = contributions_[k];
                    const ShadowLookup& p = points_[k];
                    const core::Rgb value(c.r[lane] * p.r[lane], c.g[lane] * p.g[lane],
                                          c.b[lane] * p.b[lane]);
                    if (!core::is_black(value)) add(*tiles_[k], lane, value);
                }
        }
    }
    std::uint64_t lookups() const { return lookups_; }

  private:
    void look_up(const ReceiverStore& store, const VplSet& vpls, float bound, const MappedVpl& light);

    core::ShadowPacket packet_{};
    std::vector<const ReceiverStore::Tile*> tiles_;
    std::vector<ShadowLookup> points_;
    std::vector<GatherScratch::Contribution> contributions_;
    std::uint64_t lookups_ = 0;
};

}  // namespace mote::lights
