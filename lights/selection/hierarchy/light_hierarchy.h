// The light tree of lightcuts: a binary tree over VPLs of like position and direction (Walter et al. 2005,
// Sec. 3.1), split by LightPartition.
//
// One flat array in depth-first order: a cluster of three VPLs or more has its node, then the nodes of its
// left child, then those of its right child. Clusters of one VPL or two are computed from the leaves, which
// saves a third of the nodes. So the index of every cluster is known, and threads build disjoint subtrees.
// The bits do not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "lights/selection/hierarchy/light_node.h"

namespace mote::lights {

/// A cluster of VPLs: index of its node, and its range in the order of VPLs.
struct LightCluster {
    std::uint32_t node = 0, first = 0, count = 0;
    bool single() const { return count == 1; }
    bool has_node() const { return count > 2; }
};

class LightHierarchy {
  public:
    LightHierarchy() = default;
    /// Lights of energy 0 are left out. `max_bytes` is for memory_bytes() of all lights and what building
    /// takes besides; throws core::InputError where it does not suffice, and for energies that are negative
    /// or not finite. Keeps a reference to the leaves.
    explicit LightHierarchy(const LightLeaves& leaves, std::size_t max_bytes = std::size_t(-1));

    bool empty() const { return order_.empty(); }
    std::size_t size() const { return order_.size(); }  ///< lights of energy above 0
    LightCluster root() const { return {0, 0, std::uint32_t(order_.size())}; }
    /// Precondition: !single().
    LightCluster left(const LightCluster& c) const {
        if (!c.has_node()) return {0, c.first, 1};
        return {c.node + 1, c.first, nodes_[c.node].left_count};
    }
    LightCluster right(const LightCluster& c) const {
        if (!c.has_node()) return {0, c.first + 1, 1};
        const LightNode& node = nodes_[c.node];
        return {c.node + 1 + node.left_nodes, c.first + node.left_count, c.count - node.left_count};
    }
    /// Node of a cluster.
    LightNode node(const LightCluster& c) const {
        if (c.has_node()) return nodes_[c.node];
        const LightNode first = leaves_->leaf(order_[c.first]);
        return c.single() ? first : united(first, leaves_->leaf(order_[c.first + 1]));
    }
    /// average(E) of a cluster.
    float weight(const LightCluster& c) const {
        if (c.has_node()) return nodes_[c.node].weight();
        return c.single() ? weights_[c.first] : weights_[c.first] + weights_[c.first + 1];
    }
    /// VPL at an index of the order, and its average(E).
    std::uint32_t light_at(std::uint32_t index) const { return order_[index]; }
    float weight_at(std::uint32_t index) const { return weights_[index]; }
    /// Index where the prefix sum of a cluster's weights reaches `fraction` of them: for an even random
    /// number in [0, 1) a VPL in proportion to average(E).
    std::uint32_t index_at(const LightCluster& c, double fraction) const;
    /// Prefetches for index_at() and light_at().
    void prefetch_weights(const LightCluster& c) const { __builtin_prefetch(&weights_[c.first]); }
    void prefetch_light_at(std::uint32_t index) const { __builtin_prefetch(&order_[index]); }

    /// Prefetches a cluster's node, and its left child.
    void prefetch_node(const LightCluster& c) const {
        if (!c.has_node()) return;
        __builtin_prefetch(nodes_.data() + c.node);
        __builtin_prefetch(nodes_.data() + c.node + 1);
    }
    /// Prefetches the two children of a cluster, whose own node is in the cache.
    void prefetch(const LightCluster& c) const {
        if (!c.has_node()) return;
        __builtin_prefetch(nodes_.data() + c.node + 1);
        __builtin_prefetch(nodes_.data() + c.node + 1 + nodes_[c.node].left_nodes);
    }
    /// VPLs of a cluster.
    std::span<const std::uint32_t> lights(const LightCluster& c) const {
        return std::span(order_).subspan(c.first, c.count);
    }
    std::size_t memory_bytes() const {
        return nodes_.size() * sizeof(LightNode) + order_.size() * (sizeof(std::uint32_t) + sizeof(float)) +
               sums_.size() * sizeof(double);
    }
    /// At most; usually two thirds as many nodes.
    static constexpr std::size_t bytes_a_light =
        sizeof(LightNode) + sizeof(std::uint32_t) + sizeof(float) + 1;
    static constexpr std::size_t building_bytes_a_light = 32;  ///< besides, while it is built

  private:
    const LightLeaves* leaves_ = nullptr;
    std::vector<LightNode> nodes_;      ///< of clusters of three or more
    std::vector<std::uint32_t> order_;  ///< lights
    std::vector<float> weights_;        ///< average(E) in this order
    static constexpr std::uint32_t block = 32;
    std::vector<double> sums_;  ///< of the weights before every block
};

}  // namespace mote::lights
