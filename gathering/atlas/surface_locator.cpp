#include "gathering/atlas/surface_locator.h"

#include <algorithm>
#include <numeric>

namespace mote::gathering {

using namespace core;

SurfaceLocator::SurfaceLocator(const SurfaceTriangles& surfaces)
    : surfaces_(surfaces), by_primitive_(surfaces.size()) {
    std::iota(by_primitive_.begin(), by_primitive_.end(), 0u);
    const auto key = [&](std::uint32_t t) { return std::pair(surfaces.shape[t], surfaces.primitive[t]); };
    std::stable_sort(by_primitive_.begin(), by_primitive_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::uint32_t i = 0; i < by_primitive_.size();) {
        const std::uint32_t number = surfaces.shape[by_primitive_[i]];
        if (shapes_.size() <= number) shapes_.resize(number + 1);
        Shape& shape = shapes_[number];
        shape.first = i;
        for (; i < by_primitive_.size() && surfaces.shape[by_primitive_[i]] == number; ++i, ++shape.count)
            shape.one_each = shape.one_each && surfaces.primitive[by_primitive_[i]] == shape.count;
        if (shape.one_each) continue;
        std::vector<Vec3> middles;
        for (std::uint32_t k = shape.first; k < i; ++k) {
            const auto& c = surfaces.corners[by_primitive_[k]];
            middles.push_back((c[0] + c[1] + c[2]) / 3.0f);
        }
        shape.tree = std::uint32_t(trees_.size());
        trees_.emplace_back(middles);
    }
}

std::optional<TrianglePlace> SurfaceLocator::place(std::uint32_t triangle, const Vec3& p) const {
    const auto& c = surfaces_.corners[triangle];
    const Vec3d a(c[1] - c[0]), b(c[2] - c[0]), d(p - c[0]), n = glm::cross(a, b);
    const double square = glm::dot(n, n);
    if (!(square > 0.0)) return std::nullopt;
    return TrianglePlace{triangle, float(glm::dot(glm::cross(d, b), n) / square),
                         float(glm::dot(glm::cross(a, d), n) / square)};
}

std::optional<TrianglePlace> SurfaceLocator::find(const SurfaceHit& hit) const {
    if (!hit.shape || hit.shape->index >= shapes_.size()) return std::nullopt;
    const Shape& shape = shapes_[hit.shape->index];
    if (shape.one_each) {
        if (hit.primitive >= shape.count) return std::nullopt;
        return place(by_primitive_[shape.first + hit.primitive], hit.position);
    }
    const KdTree& tree = trees_[shape.tree];
    std::vector<KdTree::Neighbour> nearest;
    tree.nearest(hit.position, 8, infinity, nearest);
    std::optional<TrianglePlace> best;
    float outside = infinity;  // how far beyond its triangle's border the place is
    for (const KdTree::Neighbour& n : nearest) {
        const auto p = place(by_primitive_[shape.first + tree.order()[n.index]], hit.position);
        if (!p) continue;
        const float beyond = -std::min(0.0f, std::min(p->u, std::min(p->v, 1.0f - p->u - p->v)));
        if (!best || beyond < outside) best = p, outside = beyond;
    }
    return best;
}

}  // namespace mote::gathering
