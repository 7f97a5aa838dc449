// A few virtual point lights for a tile of sixteen receivers, drawn by the hierarchy: selection policies of
// the gather (virtual_lights/vpl_choice.h) that are unbiased.
//
// Going down, each part of a group has the share of what it is expected to send to the tile
// (expected_light()), and where neither part is expected to send any, that of its energy: so the
// probabilities of all lights add up to 1. All sixteen receivers look at the same lights, and shadow rays
// stay packets.
//
// Sampling by the tree (Estevez and Kulla 2018): n lights from all, their random numbers one in each n-th of
// [0, 1); all go down together, so groups near the root are looked at once. Stochastic lightcuts (Yuksel
// 2019): a cut of n groups, where the group that is expected to send most is parted first, and one light from
// each. Differs from the paper in that the cut is one of a tile, made without visibility.
#pragma once

#include <vector>

#include "core/math/random.h"
#include "lights/selection/cluster_bounds.h"
#include "lights/selection/light_hierarchy.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

/// Probability that going down from a group of several lights chooses its left part.
double left_share(const LightHierarchy& lights, const LightCluster& group, const ReceiverBounds& receivers,
                  float bound);

/// With which probability each light, by its place in the order, is drawn from `group`; 0 outside of it.
std::vector<double> probabilities(const LightHierarchy& lights, const LightCluster& group,
                                  const ReceiverBounds& receivers, float bound);

/// Memory that one task uses again.
class LightSampler {
  public:
    /// n lights, each with the number of draws over n p. Lights drawn twice come once. Valid until the next
    /// call. `bound`: b of the geometry term [1/m^2], infinity for none.
    std::span<const WeightedVpl> by_tree(const LightHierarchy& lights, const ReceiverBounds& receivers,
                                         float bound, std::uint32_t n, core::Rng& rng);
    /// One light from each group of a cut of at most n, with 1 / p.
    std::span<const WeightedVpl> by_cut(const LightHierarchy& lights, const ReceiverBounds& receivers,
                                        float bound, std::uint32_t n, core::Rng& rng);

    struct Group {
        LightCluster cluster;
        double expected;
    };
    /// The cut of the last by_cut(): without groups that send nothing.
    std::span<const Group> cut() const { return cut_; }

  private:
    /// numbers_[first, last) choose lights of a group, which was reached with probability p; each counts
    /// scale / p. draw() does all tasks_, and those that come of them.
    struct Task {
        LightCluster group;
        double p;
        std::size_t first, last;
    };
    void draw(const LightHierarchy& lights, const ReceiverBounds& receivers, float bound, double scale);
    void make_cut(const LightHierarchy& lights, const ReceiverBounds& receivers, float bound,
                  std::uint32_t n);

    std::vector<double> numbers_;
    std::vector<Task> tasks_;
    std::vector<Group> cut_;
    std::vector<WeightedVpl> drawn_;
};

}  // namespace mote::lights
