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
// one of a tile, made without visibility, but for what was learned (learned_shares.h): then "expected" is
// times m.
#pragma once

#include <vector>

#include "core/math/random.h"
#include "lights/selection/learned_shares.h"
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

    /// The same with `each` lights from each of at most n groups, where below the groups energy alone counts:
    /// candidates for whoever looks at each of them.
    std::span<const WeightedVpl> from_groups(const LightTree& tree, const ReceiverGroups& receivers,
                                             float bound, std::uint32_t n, std::uint32_t each,
                                             core::Rng& rng);

    /// From now on draws ask these, and learn() tells them; null: nothing is learned.
    void use(LearnedShares* learned) { learned_ = learned; }
    /// What arrived of the i-th drawn light, times its weight, at all receivers; or what would if nothing
    /// stood between, and what is known of rays to it: the sum of squares of what they let through.
    void learn(std::size_t i, double light, float rays = 0.0f, float ray_squares = 0.0f);
    /// In the root of the mean square, what is thought to stand between receivers and the i-th drawn light.
    float seen(std::size_t i) const { return learned_ ? origins_[i].seen : 1.0f; }

    /// Neighbouring parts of a node.
    struct Group {
        std::uint32_t node, values;  ///< what the parts of the node are expected to send: a place in a list
        int first, last;             ///< the parts [first, last)
        bool is_light;
        double expected;  ///< of these parts, times m
    };
    /// The cut of the last by_cut(): without groups that send nothing.
    std::span<const Group> cut() const { return cut_; }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A part on the way to a drawn light, for learn().
    struct Step {
        std::uint32_t node, above;  ///< above: another step
        int part;
        double per_expected;  ///< p of the part over what it is expected to send; 0: as of the step below
    };
    /// `count` lights of a node that was reached with probability p; each counts scale / p. draw() does all
    /// tasks_, and those that come of them.
    struct Task {
        std::uint32_t node, count, step;
        int levels;  ///< so many from here on are steps
        LearnedMean mean;
        bool known;        ///< may more be known of its parts?
        double p, energy;  ///< energy: a share of all lights'
    };
    /// What the parts of a node are expected to send, over its energy: times m over that of the node, and
    /// without.
    struct Values {
        std::array<float, most_parts> light, plain;
        LearnedShares::Means means;
        LearnedMean above;  ///< of the node
        std::uint32_t step;
        bool known;
        double energy;
    };
    /// So many levels are learned of: from the root on, and below the groups of a cut.
    static constexpr int levels_of_draws = 4, levels_below_groups = 1;
    void begin(const ReceiverGroups& receivers);
    void draw(const LightTree& tree, const ReceiverGroups& receivers, float bound, double scale,
              core::Rng& rng);
    void make_cut(const LightTree& tree, const ReceiverGroups& receivers, float bound, std::uint32_t n);
    void add_node(const LightTree& tree, const ReceiverGroups& receivers, float bound, const Task& node);
    void add_group(const LightTree& tree, Group group);
    void draw_from(const LightTree& tree, const Group& group, std::uint32_t count, core::Rng& rng);
    void add_light(std::uint32_t light, double weight, std::uint32_t step, double per_weight,
                   const LearnedMean& mean);
    LearnedMean of_all() const { return learned_ ? learned_->of_all() : LearnedMean{}; }
    std::uint32_t add_step(const Step& step);
    bool learned(const Task& task, std::array<float, most_parts>& light, LearnedShares::Means& means) const;

    LearnedShares* learned_ = nullptr;
    bool looked_at_ = false;
    double per_light_ = 1.0;  ///< 1 over the weights of the receivers
    std::vector<Step> steps_;
    /// Of a drawn light: its last step, what makes its weight 1 / p, and seen().
    struct Origin {
        std::uint32_t step;
        float per_weight, seen;
    };
    std::vector<Origin> origins_;  ///< by drawn light, where anything is learned
    std::vector<Task> tasks_;
    std::vector<Group> cut_;
    std::vector<Values> values_;
    std::vector<WeightedVpl> drawn_;
};

}  // namespace mote::lights
