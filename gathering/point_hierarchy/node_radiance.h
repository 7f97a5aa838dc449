// Light that leaves points, and its mean over the points of every node (the pull step of Engelhardt 2013,
// Sec. 8.3).
#pragma once

#include "gathering/point_hierarchy/point_hierarchy.h"

namespace mote::gathering {

class NodeRadiance {
  public:
    static constexpr std::size_t bytes_per_point = 2 * sizeof(core::Rgb);  ///< and side

    /// Diffuse radiance of each point in the surfels' order, on the front, and on the back where that is not
    /// empty: an empty back is black [W/(m^2 sr); divide a radiosity by pi]. Throws InputError where a span
    /// has another size than the hierarchy, or a value is not finite.
    NodeRadiance(const PointHierarchy& hierarchy, std::span<const core::Rgb> front,
                 std::span<const core::Rgb> back = {});

    /// Mean over the node's points; nodes are numbered as in PointHierarchy::nodes().
    const core::Rgb& of(std::uint32_t node, bool back) const {
        return back ? (back_.empty() ? black_ : back_[node]) : front_[node];
    }
    bool has_back() const { return !back_.empty(); }  ///< else backs are black

  private:
    std::vector<core::Rgb> front_, back_;
    core::Rgb black_{0.0f};
};

/// Means of any value that can be added and scaled, leaves in the surfels' order, nodes as in nodes().
template <typename Value>
std::vector<Value> pulled_up(const PointHierarchy& hierarchy, std::span<const Value> of_surfels) {
    std::vector<Value> values(hierarchy.nodes().size());
    for (std::uint32_t i = 0; i < hierarchy.points(); ++i) values[i] = of_surfels[hierarchy.order()[i]];
    for (std::uint32_t level = 1; level < hierarchy.levels(); ++level)
        for (std::uint32_t i = 0; i < hierarchy.count(level); ++i) {
            const NodePlace node{level, i}, a = node.first_child(), b{a.level, a.index + 1};
            Value& mean = values[hierarchy.node_index(node)];
            mean = values[hierarchy.node_index(a)];
            if (!hierarchy.exists(b)) continue;
            const float share = float(hierarchy.points_below(b)) / float(hierarchy.points_below(node));
            mean = mean + share * (values[hierarchy.node_index(b)] - mean);
        }
    return values;
}

}  // namespace mote::gathering
