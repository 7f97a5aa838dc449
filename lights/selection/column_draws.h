// One light drawn from each cluster, with a probability in proportion to its weight, that counts 1 / p times:
// unbiased for any clusters and weights, as long as no light that can send light has the weight 0 (Hasan et
// al. 2007).
#pragma once

#include "lights/selection/column_clusters.h"
#include "lights/virtual_lights/vpl_choice.h"

namespace mote::lights {

class ColumnDraws {
  public:
    ColumnDraws() = default;
    /// `weights` by member, finite and not negative. Members of weight 0 have a chance of about 1e-9.
    ColumnDraws(ColumnClusters clusters, std::span<const float> weights);

    std::size_t size() const { return clusters_.size(); }
    const ColumnClusters& clusters() const { return clusters_; }
    /// Of the i-th of all members, in units of its cluster.
    double weight(std::size_t i) const;
    /// Probability of the i-th of all members within its cluster.
    double probability(std::size_t i) const;
    /// Appends a light of each cluster.
    void draw(core::Rng& rng, std::vector<WeightedVpl>& drawn) const;
    std::size_t memory_bytes() const {
        return clusters_.members.size() * sizeof(std::uint32_t) + upto_.size() * sizeof(double) +
               clusters_.first.size() * sizeof(std::size_t);
    }

  private:
    ColumnClusters clusters_;
    std::vector<double> upto_;  ///< sums of weights within the cluster, by member
};

}  // namespace mote::lights
