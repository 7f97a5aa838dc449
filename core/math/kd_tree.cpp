#include "core/math/kd_tree.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>

#include "core/math/bounds.h"

namespace mote::core {

namespace {
constexpr std::size_t parallel_from = 8192;  ///< smaller ranges are not worth a task

int widest_axis(const Bounds3& box) {
    const Vec3 extent = box.upper - box.lower;
    if (extent.x >= extent.y && extent.x >= extent.z) return 0;
    return extent.y >= extent.z ? 1 : 2;
}
}  // namespace

KdTree::KdTree(std::span<const Vec3> points)
    : points_(points.size()), axes_(points.size()), order_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(points, 0, points.size());
    tbb::parallel_for(std::size_t(0), order_.size(), [&](std::size_t i) { points_[i] = points[order_[i]]; });
}

void KdTree::build(std::span<const Vec3> points, std::size_t first, std::size_t last) {
    if (last - first < 2) return;
    Bounds3 box;
    for (std::size_t i = first; i < last; ++i) box.extend(points[order_[i]]);
    const int axis = widest_axis(box);
    const std::size_t middle = first + (last - first) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(first), at(middle), at(last), [&](std::uint32_t a, std::uint32_t b) {
        const float pa = points[a][axis], pb = points[b][axis];
        return pa != pb ? pa < pb : a < b;  // equal points must not make the order depend on the library
    });
    axes_[middle] = std::uint8_t(axis);
    const auto below = [&] { build(points, first, middle); };
    const auto above = [&] { build(points, middle + 1, last); };
    if (last - first >= parallel_from)
        tbb::parallel_invoke(below, above);
    else
        below(), above();
}

struct KdTree::Search {
    Vec3 p;
    std::size_t k;
    float limit;  ///< squared: nothing farther can be among the nearest
    std::vector<Neighbour>& heap;

    void insert(const Neighbour& candidate) {
        if (candidate.distance_squared > limit) return;
        if (heap.size() == k) {
            if (!(candidate < heap.front())) return;
            std::pop_heap(heap.begin(), heap.end());
            heap.back() = candidate;
        } else {
            heap.push_back(candidate);
        }
        std::push_heap(heap.begin(), heap.end());
        if (heap.size() == k) limit = heap.front().distance_squared;
    }
};

void KdTree::search(Search& s, std::size_t first, std::size_t last) const {
    while (first < last) {
        const std::size_t middle = first + (last - first) / 2;
        const Vec3& root = points_[middle];
        const Vec3 d = s.p - root;
        const float beyond = d[axes_[middle]];  // signed distance to the root's plane
        if (beyond < 0.0f) {
            search(s, first, middle);
            first = middle + 1;
        } else {
            search(s, middle + 1, last);
            last = middle;
        }
        s.insert({glm::dot(d, d), std::uint32_t(middle)});
        if (sqr(beyond) > s.limit) return;
    }
}

void KdTree::nearest(const Vec3& p, std::size_t k, float max_distance, std::vector<Neighbour>& heap) const {
    heap.clear();
    if (k == 0) return;
    Search s{p, k, sqr(max_distance), heap};
    search(s, 0, points_.size());
}

}  // namespace mote::core
