// Samples of virtual point lights for a tile of receivers, by a light tree: unbiased.
//
// Going down, each child of a node has a probability in proportion to its importance for the receivers, and
// to its energy where no child has any importance: so the probabilities of all VPLs add up to 1. All
// receivers energy_fraction the samples, and shadow rays stay packets.
//
// Sampling by the tree (Estevez and Kulla 2018): n samples from the root. They descend together, so nodes
// near the root are evaluated once; a child of probability p gets n p of its parent's samples, rounded up or
// down by one random number for all children. Stochastic lightcuts (Yuksel 2019): a cut of n clusters, where
// the cluster of the largest importance is split first, and one sample from each. Unlike in the paper, a tile
// has one cut, made without visibility but for what is learned (learned_importance.h), which scales
// importances by m.
#pragma once

#include <vector>

#include "core/math/random.h"
#include "lights/selection/hierarchy/wide_light_tree.h"
#include "lights/selection/stochastic/learned_importance.h"
#include "lights/selection/stochastic/receiver_clusters.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

/// Probabilities of VPLs of index below `lights`, with one sample by_tree().
std::vector<double> probabilities(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                                  std::size_t lights);

/// Reuses its memory from tile to tile of a task.
class LightSampler {
  public:
    /// n samples, each VPL with its number of samples over n p; a VPL sampled twice comes once. Valid until
    /// the next call. `bound`: b of the geometry term [1/m^2], infinity for none.
    std::span<const WeightedVpl> by_tree(const WideLightTree& tree, const ReceiverClusters& receivers,
                                         float bound, std::uint32_t n, core::Rng& rng);
    /// One VPL from each cluster of a cut of at most n, with weight 1 / p.
    std::span<const WeightedVpl> by_cut(const WideLightTree& tree, const ReceiverClusters& receivers,
                                        float bound, std::uint32_t n, core::Rng& rng);

    /// `each` VPLs from each of at most n clusters, where below the clusters energy alone counts: candidates
    /// that are evaluated afterwards.
    std::span<const WeightedVpl> from_clusters(const WideLightTree& tree, const ReceiverClusters& receivers,
                                               float bound, std::uint32_t n, std::uint32_t each,
                                               core::Rng& rng);

    /// From now on importances are scaled by these, and learn() updates them; null: nothing is learned.
    void learn_into(LearnedImportance* learned) { learned_ = learned; }
    /// Light of the i-th sample at all receivers, times its weight; or its unoccluded light, and the number
    /// of rays to it with the sum of squares of their visibility.
    void learn(std::size_t i, double light, float rays = 0.0f, float ray_squares = 0.0f);
    /// Expected visibility of the i-th sample, root of the mean square.
    float visibility(std::size_t i) const { return learned_ ? origins_[i].visibility : 1.0f; }

    /// Neighbouring children of a node.
    struct Cluster {
        std::uint32_t node, values;  ///< values: index of the importances of the node's children
        int first, last;             ///< children [first, last)
        bool is_light;
        double importance;  ///< of these children, times m
    };
    /// The cut of the last by_cut(), without clusters of importance 0.
    std::span<const Cluster> cut() const { return cut_; }

  private:
    static constexpr std::uint32_t none = 0xffffffffu;
    /// A child on the way to a sample, for learn().
    struct Step {
        std::uint32_t node, above;  ///< above: another step
        int child;
        double per_importance;  ///< p of the child over its importance; 0: that of the step below
    };
    /// `count` samples of a node that was reached with probability p; each counts scale / p.
    /// sample_descendants() does all tasks_, and those that they create.
    struct Task {
        std::uint32_t node, count, step;
        int levels;  ///< number of levels from here on that are steps
        LearnedMean mean;
        bool known;        ///< its children may have learned importances
        double p, energy;  ///< energy: fraction of all VPLs'
    };
    /// Importances of the children of a node, over its energy: scaled by m over that of the node, and plain.
    struct Values {
        std::array<float, max_children> light, plain;
        LearnedImportance::Means means;
        LearnedMean above;  ///< of the node
        std::uint32_t step;
        bool known;
        double energy;
    };
    /// Number of levels that learn: from the root on, and below the clusters of a cut.
    static constexpr int levels_from_root = 4, levels_below_clusters = 1;
    void begin(const ReceiverClusters& receivers);
    void sample_descendants(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                            double scale, core::Rng& rng);
    void make_cut(const WideLightTree& tree, const ReceiverClusters& receivers, float bound, std::uint32_t n);
    void add_node(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                  const Task& node);
    void add_cluster(const WideLightTree& tree, Cluster cluster);
    void sample_cluster(const WideLightTree& tree, const Cluster& cluster, std::uint32_t count,
                        core::Rng& rng);
    void add_light(std::uint32_t light, double weight, std::uint32_t step, double per_weight,
                   const LearnedMean& mean);
    LearnedMean of_all() const { return learned_ ? learned_->of_all() : LearnedMean{}; }
    std::uint32_t add_step(const Step& step);
    bool learned(const Task& task, std::array<float, max_children>& light,
                 LearnedImportance::Means& means) const;

    LearnedImportance* learned_ = nullptr;
    bool candidates_only_ = false;
    double per_light_ = 1.0;  ///< 1 over the weights of the receivers
    std::vector<Step> steps_;
    /// Per sample: its last step, the factor that makes its weight 1 / p, and visibility().
    struct Origin {
        std::uint32_t step;
        float per_weight, visibility;
    };
    std::vector<Origin> origins_;  ///< by sample, where anything is learned
    std::vector<Task> tasks_;
    std::vector<Cluster> cut_;
    std::vector<Values> values_;
    std::vector<WeightedVpl> samples_;
};

}  // namespace mote::lights
