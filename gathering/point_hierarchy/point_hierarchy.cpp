#include "gathering/point_hierarchy/point_hierarchy.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/math/direction_cone.h"
#include "core/math/morton.h"
#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// The smallest sphere around two.
void unite_spheres(const PointNode& a, const PointNode& b, PointNode& node) {
    const Vec3 between = b.center - a.center;
    const float distance = glm::length(between);
    if (distance + b.radius <= a.radius) {
        node.center = a.center, node.radius = a.radius;
    } else if (distance + a.radius <= b.radius) {
        node.center = b.center, node.radius = b.radius;
    } else {
        node.radius = 0.5f * (distance + a.radius + b.radius) * (1.0f + 1e-6f);
        node.center = a.center + between * ((node.radius - a.radius) / distance);
    }
}

DirectionCone cone_of(const PointNode& node) {
    return {node.axis, std::acos(std::clamp(node.cone_cos, -1.0f, 1.0f))};
}

PointNode united_nodes(const PointNode& a, const PointNode& b) {
    PointNode node;
    unite_spheres(a, b, node);
    const DirectionCone cone = united(cone_of(a), cone_of(b));
    node.axis = cone.axis, node.cone_cos = cone.angle >= pi ? -1.0f : std::cos(cone.angle);
    return node;
}

/// Which of the six axes the normal is nearest to.
std::uint64_t facing(const Vec3& n) {
    const Vec3 a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(2 * axis + (n[axis] < 0.0f));
}

/// Morton curves of the points that face along each axis, one after the other: so that the two sides of a
/// wall, and walls that meet, are nodes of their own, which are flat.
std::vector<std::uint32_t> order_of(const Surfels& surfels) {
    Bounds3 bounds;
    for (const Vec3& p : surfels.positions) bounds.extend(p);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(surfels.size());
    for (std::uint32_t i = 0; i < keyed.size(); ++i) {
        const std::uint64_t along = morton_code(surfels.positions[i], bounds) >> 3;
        keyed[i] = {facing(surfels.normals[i]) << 60 | along, i};
    }
    std::sort(keyed.begin(), keyed.end());
    std::vector<std::uint32_t> order(keyed.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
    return order;
}

}  // namespace

PointHierarchy::PointHierarchy(const Surfels& surfels, std::size_t memory_budget)
    : disc_radius_(surfels.radius), patch_(surfels.patch()) {
    const std::size_t fits = std::min<std::size_t>(memory_budget / bytes_per_point, largest_count);
    if (surfels.size() > fits)
        throw InputError(fmt::format("a hierarchy of {} points takes{}; {} points fit into the{} allowed",
                                     surfels.size(),
                                     memory_text(double(surfels.size()) * double(bytes_per_point)), fits,
                                     memory_text(double(memory_budget))));
    first_.push_back(0);
    for (auto count = std::uint32_t(surfels.size()); count > 0; count = count > 1 ? (count + 1) / 2 : 0)
        first_.push_back(first_.back() + count);
    order_ = order_of(surfels);
    nodes_.resize(first_.back());
    for (std::uint32_t i = 0; i < points(); ++i)
        nodes_[i] = {surfels.positions[order_[i]], disc_radius_, surfels.normals[order_[i]], 1.0f};
    pull_nodes();
}

void PointHierarchy::pull_nodes() {
    for (std::uint32_t level = 1; level < levels(); ++level)
        tbb::parallel_for(std::uint32_t(0), count(level), [&](std::uint32_t i) {
            const NodePlace node{level, i}, a = node.first_child(), b{a.level, a.index + 1};
            nodes_[node_index(node)] = exists(b) ? united_nodes(nodes_[node_index(a)], nodes_[node_index(b)])
                                                 : nodes_[node_index(a)];
        });
}

}  // namespace mote::gathering
