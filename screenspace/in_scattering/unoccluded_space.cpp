#include "screenspace/in_scattering/unoccluded_space.h"

#include <algorithm>

#include "core/materials/bsdf.h"

namespace mote::screenspace {

using namespace core;

namespace {

constexpr std::size_t leaf_size = 4;
/// Nodes that a query opens before it gives up: where so much is near, something is likely in the way.
constexpr std::size_t max_nodes = 200;
constexpr std::uint32_t whole = ~std::uint32_t(0);
/// Displacement of a shadow ray or its hit by rounding, relative to the largest coordinate: 16 units in the
/// last place.
constexpr double rounding = 1e-6;

/// Null BSDFs and panes, as RayTracer groups them.
bool passes_straight(const Shape& shape) { return shape.bsdf && shape.bsdf->traits().passes_straight(); }

double largest_of(const Vec3d& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// True if two sets of points are farther apart than the margin along `axis`, of any length.
bool gap(const Vec3d& axis, const auto& a, const auto& b, double margin) {
    double a0 = double(infinity), a1 = -a0, b0 = a0, b1 = a1;
    for (const Vec3d& p : a) a0 = std::min(a0, glm::dot(axis, p)), a1 = std::max(a1, glm::dot(axis, p));
    for (const Vec3d& p : b) b0 = std::min(b0, glm::dot(axis, p)), b1 = std::max(b1, glm::dot(axis, p));
    return std::max(b0 - a1, a0 - b1) > margin * (std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z));
}

bool apart(const UnoccludedSpace::Triangle& t, const UnoccludedSpace::Triangle& o, double margin) {
    const std::array<Vec3d, 3> te = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const std::array<Vec3d, 3> oe = {o[1] - o[0], o[2] - o[1], o[0] - o[2]};
    if (gap(glm::cross(oe[0], oe[1]), t, o, margin) || gap(glm::cross(te[0], te[1]), t, o, margin))
        return true;
    for (const Vec3d& a : te)
        for (const Vec3d& b : oe)
            if (gap(glm::cross(a, b), t, o, margin)) return true;
    return false;
}

}  // namespace

/// A triangle, ready for many boxes: the axes that can separate them besides those of the boxes, and the
/// triangle along each.
class UnoccludedSpace::Tree::Query {
  public:
    Query(const Triangle& t, double margin) : triangle(t), margin_(margin) {
        const std::array<Vec3d, 3> edge = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
        std::size_t n = 0;
        axis_[n++] = glm::cross(edge[0], edge[1]);
        for (const Vec3d& e : edge)
            axis_[n++] = {0, -e.z, e.y}, axis_[n++] = {e.z, 0, -e.x}, axis_[n++] = {-e.y, e.x, 0};
        for (std::size_t i = 0; i < n; ++i) {
            const auto [low, high] =
                std::minmax({glm::dot(axis_[i], t[0]), glm::dot(axis_[i], t[1]), glm::dot(axis_[i], t[2])});
            low_[i] = low, high_[i] = high;
        }
        lower_ = glm::min(glm::min(t[0], t[1]), t[2]) - margin;
        upper_ = glm::max(glm::max(t[0], t[1]), t[2]) + margin;
    }

    bool apart(const Bounds3& box) const {
        const Vec3d lower(box.lower), upper(box.upper);
        if (glm::any(glm::greaterThan(lower_, upper)) || glm::any(glm::lessThan(upper_, lower))) return true;
        const Vec3d center = 0.5 * (lower + upper), half = 0.5 * (upper - lower) + margin_;
        for (std::size_t i = 0; i < axis_.size(); ++i) {
            const double at = glm::dot(axis_[i], center), reach = glm::dot(glm::abs(axis_[i]), half);
            if (low_[i] > at + reach || high_[i] < at - reach) return true;
        }
        return false;
    }
    double margin() const { return margin_; }
    const Triangle triangle;

  private:
    std::array<Vec3d, 10> axis_;
    std::array<double, 10> low_, high_;
    Vec3d lower_, upper_;
    double margin_;
};

struct UnoccludedSpace::Tree::Entry {
    Part part;
    Bounds3 bounds;
    Vec3 center;
};

UnoccludedSpace::UnoccludedSpace(std::span<const std::shared_ptr<Shape>> shapes) {
    for (const auto& shape : shapes) (passes_straight(*shape) ? boundaries_ : surfaces_).add(*shape);
    surfaces_.build(), boundaries_.build();
}

void UnoccludedSpace::Tree::add(const Shape& shape) {
    const auto* mesh = dynamic_cast<const TriangleMesh*>(&shape);
    const auto index = std::uint32_t(shapes_.size());
    shapes_.push_back(&shape), meshes_.push_back(mesh ? &mesh->data() : nullptr);
    if (!mesh) parts_.push_back({index, whole});
    for (std::uint32_t i = 0; mesh && i < mesh->data().triangles.size(); ++i) parts_.push_back({index, i});
    largest_ = std::max(
        {largest_, largest_of(Vec3d(shape.bounds().lower)), largest_of(Vec3d(shape.bounds().upper))});
}

void UnoccludedSpace::Tree::build() {
    if (parts_.empty()) return;
    std::vector<Entry> entries;
    entries.reserve(parts_.size());
    for (const Part& part : parts_) {
        const Bounds3 box = bounds_of(part);
        entries.push_back({part, box, box.center()});
    }
    nodes_.emplace_back();
    split(entries, 0, 0, entries.size());
    nodes_.shrink_to_fit(), parts_.shrink_to_fit();
    for (std::size_t i = 0; i < parts_.size(); ++i) parts_[i] = entries[i].part;
}

Bounds3 UnoccludedSpace::Tree::bounds_of(const Part& part) const {
    if (part.triangle == whole) return shapes_[part.shape]->bounds();
    const MeshData& mesh = *meshes_[part.shape];
    Bounds3 box;
    for (const std::uint32_t corner : mesh.triangles[part.triangle]) box.extend(mesh.positions[corner]);
    return box;
}

/// Halves the parts along the axis that their centres are spread most along.
void UnoccludedSpace::Tree::split(std::vector<Entry>& entries, std::uint32_t node, std::size_t begin,
                                  std::size_t end) {
    Bounds3 box, centers;
    for (std::size_t i = begin; i < end; ++i)
        box.extend(entries[i].bounds), centers.extend(entries[i].center);
    nodes_[node].bounds = box;
    if (end - begin <= leaf_size) {
        nodes_[node].first = std::uint32_t(begin), nodes_[node].count = std::uint32_t(end - begin);
        return;
    }
    const Vec3 spread = centers.diagonal();
    const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
    const auto at = [&](std::size_t i) { return entries.begin() + std::ptrdiff_t(i); };
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(at(begin), at(middle), at(end),
                     [axis](const Entry& a, const Entry& b) { return a.center[axis] < b.center[axis]; });
    nodes_.emplace_back();
    split(entries, node + 1, begin, middle);
    const auto right = std::uint32_t(nodes_.size());
    nodes_.emplace_back();
    nodes_[node].first = right, nodes_[node].count = 0;
    split(entries, right, middle, end);
}

bool UnoccludedSpace::Tree::apart(const Query& query, const Part& part) const {
    if (query.apart(bounds_of(part))) return true;
    if (part.triangle == whole) return false;
    const MeshData& mesh = *meshes_[part.shape];
    const auto& corners = mesh.triangles[part.triangle];
    const Triangle other = {Vec3d(mesh.positions[corners[0]]), Vec3d(mesh.positions[corners[1]]),
                            Vec3d(mesh.positions[corners[2]])};
    return screenspace::apart(query.triangle, other, query.margin());
}

bool UnoccludedSpace::Tree::clear(const Triangle& t) const {
    if (nodes_.empty()) return true;
    const double margin =
        rounding * std::max({largest_, largest_of(t[0]), largest_of(t[1]), largest_of(t[2])});
    const Vec3d sum = t[0] + t[1] + t[2];
    if (!std::isfinite(margin + sum.x + sum.y + sum.z)) return false;
    const Query query(t, margin);
    std::array<std::uint32_t, 64> open;  // deeper than 2^64 parts
    std::size_t count = 0, visited = 0;
    open[count++] = 0;
    while (count > 0) {
        const std::uint32_t at = open[--count];
        const Node& node = nodes_[at];
        if (query.apart(node.bounds)) continue;
        if (++visited > max_nodes) return false;
        if (node.count == 0) {
            open[count++] = node.first, open[count++] = at + 1;
            continue;
        }
        for (std::uint32_t i = 0; i < node.count; ++i)
            if (!apart(query, parts_[node.first + i])) return false;
    }
    return true;
}

/// Beyond all shapes any distance is as good as infinity; out there the two sides are two triangles.
bool UnoccludedSpace::Tree::clear(const Vec3d& point, const Vec3d& from, const Vec3d& direction) const {
    if (nodes_.empty()) return true;
    const double far = 4.0 * (largest_ + largest_of(point) + largest_of(from));
    const Vec3d end = from + far * direction;
    return clear({point, from, end}) && clear({point, end, point + far * direction});
}

bool UnoccludedSpace::free_of_surfaces(const Vec3d& point, const Vec3d& from, const Vec3d& direction) const {
    return surfaces_.clear(point, from, direction);
}
bool UnoccludedSpace::free_of_boundaries(const Vec3d& point, const Vec3d& from,
                                         const Vec3d& direction) const {
    return boundaries_.clear(point, from, direction);
}

}  // namespace mote::screenspace
