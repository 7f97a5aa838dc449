// The receivers of a tile in a few clusters: importances are those of clusters instead of sixteen lanes.
//
// A tile on one wall is one cluster; across an edge, or in fog, there are up to four.
// Clusters are split at the widest gap along the coordinate in which they are longest: a position, in tenths
// of the diagonal of all lights, or a direction.
#pragma once

#include <array>
#include <span>

#include "lights/selection/hierarchy/receiver_bounds.h"
#include "lights/selection/hierarchy/wide_light_tree.h"

namespace mote::lights {

class ReceiverClusters {
  public:
    static constexpr int max_clusters = 4;

    struct Cluster {
        core::Bounds3 box;
        core::DirectionCone cone;  ///< as ReceiverBounds::axis_x and so on have it
        float cos_angle, sin_angle;
        float has_cosine, g_low, g_high;
        float weight;  ///< fraction of the weights of all receivers
        float max_vpl_depth;
    };

    /// The tree's root sets the unit of length.
    ReceiverClusters(const ReceiverBounds& receivers, const WideLightTree& lights);
    /// Several points of each lane.
    ReceiverClusters(std::span<const ReceiverBounds> points, const WideLightTree& lights);

    bool empty() const { return count_ == 0; }
    /// Sum of the weights of all receivers.
    float weight() const { return weight_; }
    std::span<const Cluster> all() const { return std::span(clusters_).first(std::size_t(count_)); }

  private:
    std::array<Cluster, max_clusters> clusters_;
    int count_ = 0;
    float weight_ = 0.0f;
};

/// Importance of each child: about the light that all receivers get from it, over the energy of the node. 0
/// only where no light can arrive, at most 1e36, so that probabilities stay finite where a receiver stands on
/// a light. The distance is that of the middles, and at least half the diagonals. `bound`: b of the geometry
/// term [1/m^2], infinity for none.
std::array<float, max_children> importance(const LightChildren& parts, const ReceiverClusters& receivers,
                                           float bound);

}  // namespace mote::lights
