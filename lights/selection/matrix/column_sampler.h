// One VPL sampled from each cluster, with a probability in proportion to its weight, and weight 1 / p:
// unbiased for any clusters and weights, as long as no light that can send light has the weight 0 (Hasan et
// al. 2007).
#pragma once

#include "lights/selection/matrix/column_clusters.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

class ColumnSampler {
  public:
    ColumnSampler() = default;
    /// `weights` by member, finite and not negative. Members of weight 0 have a probability of about 1e-9.
    ColumnSampler(ColumnClusters clusters, std::span<const float> weights);

    std::size_t size() const { return clusters_.size(); }
    const ColumnClusters& clusters() const { return clusters_; }
    /// Weight of the i-th of all members, in units of its cluster.
    double weight(std::size_t i) const;
    /// Probability of the i-th of all members within its cluster.
    double probability(std::size_t i) const;
    /// Appends a VPL of each cluster.
    void sample(core::Rng& rng, std::vector<WeightedVpl>& samples) const;
    std::size_t memory_bytes() const {
        return clusters_.members.size() * sizeof(std::uint32_t) + upto_.size() * sizeof(double) +
               clusters_.first.size() * sizeof(std::size_t);
    }

  private:
    ColumnClusters clusters_;
    std::vector<double> upto_;  ///< sums of weights within the cluster, by member
};

}  // namespace mote::lights
