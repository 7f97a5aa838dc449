// A few virtual point lights for a tile of receivers, or for one, drawn by a tree: selection policies of the
// gather (virtual_lights/vpl_choice.h) that are unbiased.
//
// Going down, each part of a group has the share of what it is expected to send to the receivers
// (expected_light()), and where no part is expected to send any, that of its energy: so the probabilities of
// all lights add up to 1. All receivers look at the same lights, and shadow rays stay packets.
//
// Sampling by the tree (Estevez and Kulla 2018): n lights from all. All go down together, so groups near the
// root are looked at once; a part of share p gets the n p draws of its group, rounded up or down by one
// random number for all parts. Stochastic lightcuts (Yuksel 2019): a cut of n groups, where the group that is
// expected to send most is parted first, and one light from each. Differs from the paper in that the cut is
// one of a tile, made without visibility.
#pragma once

#include <vector>

#include "core/math/random.h"
#include "lights/selection/light_tree.h"
#include "lights/selection/receiver_groups.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

/// With which probability by_tree() draws each light with one draw, for lights of index below `lights`.
std::vector<double> probabilities(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                                  std::size_t lights);

/// Memory that one task uses again.
class LightSampler {
  public:
    /// n lights, each with the number of draws over n p. Lights drawn twice come once. Valid until the next
    /// call. `bound`: b of the geometry term [1/m^2], infinity for none.
    std::span<const WeightedVpl> by_tree(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                                         std::uint32_t n, core::Rng& rng);
    /// One light from each group of a cut of at most n, with 1 / p.
    std::span<const WeightedVpl> by_cut(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                                        std::uint32_t n, core::Rng& rng);

    /// Neighbouring parts of a node.
    struct Group {
        std::uint32_t node, values;  ///< what the parts of the node are expected to send: a place in a list
        int first, last;             ///< the parts [first, last)
        bool is_light;
        double energy, expected;  ///< of the node, a share of all lights'; of these parts
    };
    /// The cut of the last by_cut(): without groups that send nothing.
    std::span<const Group> cut() const { return cut_; }

  private:
    /// `count` lights of a node that was reached with probability p; each counts scale / p. draw() does all
    /// tasks_, and those that come of them.
    struct Task {
        std::uint32_t node, count;
        double p;
    };
    void draw(const LightTree& tree, const ReceiverGroups& receivers, float bound, double scale,
              core::Rng& rng);
    void make_cut(const LightTree& tree, const ReceiverGroups& receivers, float bound, std::uint32_t n);
    void add_group(const LightTree& tree, Group group);
    void draw_from(const LightTree& tree, const Group& group, core::Rng& rng);

    using Values = std::array<float, most_parts>;
    std::vector<Task> tasks_;
    std::vector<Group> cut_;
    std::vector<Values> values_;
    std::vector<WeightedVpl> drawn_;
};

}  // namespace mote::lights
