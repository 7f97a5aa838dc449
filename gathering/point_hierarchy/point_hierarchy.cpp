#include "gathering/point_hierarchy/point_hierarchy.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/math/bounds.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Distance that nodes reach beyond their points, in radii of a disc: neighbours reach towards each other, so
/// that there are no holes, and what is beyond their edges is not theirs. At 0.7 a closed sphere has holes.
constexpr float overlap = 0.9f;

/// The ball around the middle of the box, and the cone around the mean normal, of leaves [first, last).
PointNode node_around(std::span<const PointNode> leaves) {
    Bounds3 bounds;
    Vec3d normals(0.0);
    for (const PointNode& leaf : leaves) bounds.extend(leaf.center), normals += Vec3d(leaf.axis);
    const double length = glm::length(normals);
    PointNode node{bounds.center(), 0.0f, length > 0.0 ? Vec3(normals / length) : leaves[0].axis, 1.0f};
    float farthest = 0.0f;
    for (const PointNode& leaf : leaves) {
        const Vec3 off = leaf.center - node.center;
        farthest = std::max(farthest, glm::dot(off, off));
        node.cone_cos = std::min(node.cone_cos, glm::dot(leaf.axis, node.axis));
    }
    node.radius = std::sqrt(farthest) * (1.0f + 1e-6f) + overlap * leaves[0].radius;
    node.cone_cos = length > 0.0 ? std::clamp(node.cone_cos, -1.0f, 1.0f) : -1.0f;
    return node;
}

}  // namespace

void PointHierarchy::check_memory(std::size_t points, std::size_t budget) {
    const std::size_t fits = std::min<std::size_t>(budget / bytes_per_point, largest_count);
    if (points > fits)
        throw InputError(fmt::format("a hierarchy of {} points takes{}; {} points fit into the{} allowed",
                                     points, memory_text(double(points) * double(bytes_per_point)), fits,
                                     memory_text(double(budget))));
}

PointHierarchy::PointHierarchy(const Surfels& surfels, std::size_t memory_budget)
    : disc_radius_(surfels.radius), patch_(surfels.patch()) {
    check_memory(surfels.size(), memory_budget);
    first_.push_back(0);
    for (auto count = std::uint32_t(surfels.size()); count > 0; count = count > 1 ? (count + 1) / 2 : 0)
        first_.push_back(first_.back() + count);
    order_ = point_order(surfels);
    nodes_.resize(first_.back());
    for (std::uint32_t i = 0; i < points(); ++i)
        nodes_[i] = {surfels.positions[order_[i]], disc_radius_, surfels.normals[order_[i]], 1.0f};
    for (std::uint32_t level = 1; level < levels(); ++level)
        tbb::parallel_for(std::uint32_t(0), count(level), [&](std::uint32_t i) {
            const NodePlace node{level, i};
            nodes_[node_index(node)] =
                node_around(std::span<const PointNode>(nodes_).subspan(i << level, points_below(node)));
        });
}

}  // namespace mote::gathering
