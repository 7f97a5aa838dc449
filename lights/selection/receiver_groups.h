// The receivers of a tile in a few groups: what drawing lights looks at instead of sixteen lanes.
//
// A tile that sees one wall is one group; where it looks past an edge, or into fog, there are up to four.
// Groups are parted at the widest gap along the coordinate in which they are longest: a position, in tenths
// of the diagonal of all lights, or a direction.
#pragma once

#include <array>
#include <span>

#include "lights/selection/light_tree.h"
#include "lights/selection/receiver_bounds.h"

namespace mote::lights {

class ReceiverGroups {
  public:
    static constexpr int most = 4;

    struct Group {
        core::Bounds3 box;
        core::DirectionCone cone;  ///< as ReceiverBounds::axis_x and so on have it
        float cos_angle, sin_angle;
        float has_cosine, g_low, g_high;
        float weight;  ///< share of the weights of all receivers
        float max_vpl_depth;
    };

    /// The tree's root tells what is far.
    ReceiverGroups(const ReceiverBounds& receivers, const LightTree& lights);
    /// Of several points of each lane.
    ReceiverGroups(std::span<const ReceiverBounds> points, const LightTree& lights);

    bool empty() const { return count_ == 0; }
    /// Of all receivers, in all.
    float weight() const { return weight_; }
    std::span<const Group> all() const { return std::span(groups_).first(std::size_t(count_)); }

  private:
    std::array<Group, most> groups_;
    int count_ = 0;
    float weight_ = 0.0f;
};

/// By part: about the light that all receivers get from it, over the energy of the group of the parts: 0 only
/// where nothing can arrive, at most 1e36, so that shares stay numbers where a receiver stands on a light.
/// The distance is that of the middles, and at least half the diagonals. `bound`: b of the geometry term
/// [1/m^2], infinity for none.
std::array<float, most_parts> expected_light(const LightParts& parts, const ReceiverGroups& receivers,
                                             float bound);

}  // namespace mote::lights
