// Points on surfaces as a complete binary tree in one array (Engelhardt 2013, Sec. 8.1.1).
//
// Points lie in an order in which neighbours are near (point_order.h); node i of level l holds points [i 2^l,
// (i + 1) 2^l) as far as there are any, so that any number of points has a tree. Levels lie one after the
// other, leaves first and the root last. Children, and the next node of a walk that does not enter a node,
// follow from level and index: nothing of it is stored.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "gathering/point_hierarchy/point_order.h"

namespace mote::gathering {

/// Bounds of the points of a node: a ball, and a cone of normals.
struct PointNode {
    core::Vec3 center;  ///< [m]
    float radius;       ///< of a leaf its disc's; of a node, of a ball that reaches beyond its points [m]
    core::Vec3 axis;    ///< unit: mean normal
    float cone_cos;  ///< cosine of the largest angle between the axis and a point's normal; -1: any direction
};

/// Position of a node in the tree.
struct NodePlace {
    std::uint32_t level;  ///< 0: leaves
    std::uint32_t index;  ///< within the level

    /// Not of leaves. The second child is the one after it, where that exists.
    NodePlace first_child() const { return {level - 1, 2 * index}; }
    /// The first node after this one and all below it. Beyond the tree's end: exists() says no.
    NodePlace skip() const {
        const auto up = std::uint32_t(std::countr_zero(index + 1));
        return {level + up, (index + 1) >> up};
    }
};

/// The tree over a set of points.
class PointHierarchy {
  public:
    static constexpr std::uint32_t largest_count = 1u << 24;  ///< of points
    /// Memory of nodes and order [B].
    static constexpr std::size_t bytes_per_point = 2 * sizeof(PointNode) + sizeof(std::uint32_t);

    /// Throws InputError where so many points exceed 2^24 or the budget [B], naming the count that fits.
    static void check_memory(std::size_t points, std::size_t budget);
    /// Throws InputError for more than 2^24 points or more memory than the budget, naming the count that
    /// fits. Does not refer to the points later. The same for any number of threads.
    explicit PointHierarchy(const Surfels& surfels, std::size_t memory_budget = std::size_t(1) << 30);

    /// Number of points, which are the leaves.
    std::uint32_t points() const { return first_.size() > 1 ? first_[1] : 0; }
    bool empty() const { return points() == 0; }        ///< there is no node then
    float disc_radius() const { return disc_radius_; }  ///< of each point [m]
    double patch() const { return patch_; }             ///< area of each point [m^2]
    /// order()[i] is the index of leaf i among the surfels.
    std::span<const std::uint32_t> order() const { return order_; }

    /// All nodes, leaves first: node i is the disc of point order()[i] for i < points().
    std::span<const PointNode> nodes() const { return nodes_; }
    /// 0 where there are no points.
    std::uint32_t levels() const { return std::uint32_t(first_.size()) - 1; }
    std::uint32_t first(std::uint32_t level) const { return first_[level]; }  ///< node index
    /// Number of nodes of a level.
    std::uint32_t count(std::uint32_t level) const { return first_[level + 1] - first_[level]; }
    NodePlace root() const { return {levels() - 1, 0}; }  ///< of a tree that is not empty
    /// True if the tree has a node there.
    bool exists(const NodePlace& p) const { return p.level < levels() && p.index < count(p.level); }
    /// Into nodes().
    std::uint32_t node_index(const NodePlace& p) const { return first_[p.level] + p.index; }
    /// Number of points below the node.
    std::uint32_t points_below(const NodePlace& p) const {
        return std::min(points() - (p.index << p.level), 1u << p.level);
    }
    /// [B]
    std::size_t memory_bytes() const {
        return nodes_.capacity() * sizeof(PointNode) + order_.capacity() * sizeof(std::uint32_t);
    }

  private:
    std::vector<std::uint32_t> first_;  ///< node index at which each level begins, and the number of nodes
    std::vector<std::uint32_t> order_;
    std::vector<PointNode> nodes_;
    float disc_radius_ = 0.0f;
    double patch_ = 0.0;
};

}  // namespace mote::gathering
