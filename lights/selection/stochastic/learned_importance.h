// Mean squares of estimate over importance, learned by cluster of VPLs from previous tiles.
//
// One sample of a cluster of importance e estimates r e, and m^2 is the mean of r^2. Sampling clusters with
// probabilities p_i has the second moment  sum of (e_i m_i)^2 / p_i,  which is least where p_i is in
// proportion to e_i m_i (Cauchy and Schwarz; Vevoda et al. 2018 learn alike, with a prior). So occluded
// clusters, and lobes that send less than their importance, are sampled less often. After n samples m^2 is
//   (sum of r^2 + k m^2 of the parent) / (n + k),
// at min_fraction a fixed fraction of the parent's: so no probability is 0, and n samples without light lower
// it by sqrt(1 + n/k) at most. Estimates stay unbiased because probabilities depend on other tiles alone.
//
// Resampling evaluates the unoccluded r of every candidate, and the visibility of few rays: there m^2 is the
// product of two means, each learned by itself.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lights/selection/hierarchy/wide_light_tree.h"

namespace mote::lights {

/// m^2 of a cluster: of unoccluded light, or of light as it arrives, times that of rays.
struct LearnedMean {
    float unoccluded = 1.0f, rays = 1.0f;
    float square() const { return unoccluded * rays; }
    /// Ratio of m to that of another cluster.
    float over(const LearnedMean& other) const { return std::sqrt(square() / other.square()); }
};

class LearnedImportance {
  public:
    using Means = std::array<LearnedMean, max_children>;

    bool empty() const { return all_.unoccluded.count == 0.0f; }
    /// m^2 of the root. Only ratios to it count: 1 before any light arrived.
    LearnedMean of_all() const { return {all_.unoccluded.mean(), all_.rays.mean()}; }
    /// m^2 of the children of a node, whose own is `above`. Returns false where nothing is learned: all are
    /// the same.
    bool of_children(std::uint32_t node, const LearnedMean& above, Means& means) const {
        means.fill(above);
        const Node* seen = find(node);
        if (!seen) return false;
        for (std::size_t i = 0; i < max_children; ++i)
            means[i] = {(*seen)[i].unoccluded.mean(above.unoccluded, prior_unoccluded),
                        (*seen)[i].rays.mean(above.rays, prior_rays)};
        return true;
    }
    /// Adds one sample's r^2 to a child of a node, and the number and squares of its rays.
    void add(std::uint32_t node, int child, float square, float rays, float ray_squares) {
        if (Node* seen = find_or_add(node)) (*seen)[std::size_t(child)].add(square, rays, ray_squares);
    }
    void add_to_all(float square, float rays, float ray_squares) { all_.add(square, rays, ray_squares); }

  private:
    static constexpr float prior_unoccluded = 4.0f, prior_rays = 8.0f, min_fraction = 1.0f / 16.0f;
    struct Sum {
        float count = 0.0f, squares = 0.0f;

        float mean() const { return squares > 0.0f ? squares / count : 1.0f; }
        float mean(float above, float prior) const {
            return std::max((squares + prior * above) / (count + prior), min_fraction * above);
        }
    };
    struct Seen {
        Sum unoccluded, rays;

        void add(float square, float ray_count, float ray_squares) {
            unoccluded.count += 1.0f, unoccluded.squares += square;
            rays.count += ray_count, rays.squares += ray_squares;
        }
    };
    using Node = std::array<Seen, max_children>;
    static constexpr std::size_t size = 1 << 12;  // slots, of which a quarter stay free

    static std::size_t first_slot(std::uint32_t node) {
        return std::size_t((std::uint64_t(node) + 1) * 0x9e3779b97f4a7c15ull >> 52);
    }
    const Node* find(std::uint32_t node) const {
        if (items_.empty()) return nullptr;
        for (std::size_t p = first_slot(node); slots_[p] != 0; p = (p + 1) % size)
            if (nodes_[slots_[p] - 1u] == node) return &items_[slots_[p] - 1u];
        return nullptr;
    }
    /// Null where the table is full.
    Node* find_or_add(std::uint32_t node) {
        if (slots_.empty()) slots_.resize(size);
        std::size_t p = first_slot(node);
        for (; slots_[p] != 0; p = (p + 1) % size)
            if (nodes_[slots_[p] - 1u] == node) return &items_[slots_[p] - 1u];
        if (items_.size() >= size * 3 / 4) return nullptr;
        nodes_.push_back(node), items_.emplace_back();
        slots_[p] = std::uint16_t(items_.size());
        return &items_.back();
    }

    Seen all_;
    std::vector<std::uint16_t> slots_;  ///< by hash of a node: 1 + its item; 0: none
    std::vector<std::uint32_t> nodes_;
    std::vector<Node> items_;
};

}  // namespace mote::lights
