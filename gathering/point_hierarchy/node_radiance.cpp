#include "gathering/point_hierarchy/node_radiance.h"

#include <fmt/format.h>

#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

void check(const PointHierarchy& hierarchy, std::span<const Rgb> side) {
    if (side.size() != hierarchy.points())
        throw InputError(
            fmt::format("radiance of {} points for a hierarchy of {}", side.size(), hierarchy.points()));
    for (const Rgb& value : side)
        if (!is_finite(value)) throw InputError("the radiance of points must be finite");
}

/// Means over the points of every node, from values in the surfels' order.
std::vector<Rgb> pulled_up(const PointHierarchy& hierarchy, std::span<const Rgb> of_surfels) {
    std::vector<Rgb> values(hierarchy.nodes().size());
    for (std::uint32_t i = 0; i < hierarchy.points(); ++i) values[i] = of_surfels[hierarchy.order()[i]];
    for (std::uint32_t level = 1; level < hierarchy.levels(); ++level)
        for (std::uint32_t i = 0; i < hierarchy.count(level); ++i) {
            const NodePlace node{level, i}, a = node.first_child(), b{a.level, a.index + 1};
            Rgb& mean = values[hierarchy.node_index(node)];
            mean = values[hierarchy.node_index(a)];
            if (!hierarchy.exists(b)) continue;
            const float fraction = float(hierarchy.points_below(b)) / float(hierarchy.points_below(node));
            mean = mean + fraction * (values[hierarchy.node_index(b)] - mean);
        }
    return values;
}

}  // namespace

NodeRadiance::NodeRadiance(const PointHierarchy& hierarchy, std::span<const Rgb> front,
                           std::span<const Rgb> back) {
    check(hierarchy, front);
    if (!back.empty()) check(hierarchy, back);
    front_ = pulled_up(hierarchy, front);
    if (!back.empty()) back_ = pulled_up(hierarchy, back);
}

}  // namespace mote::gathering
