#include "gathering/point_hierarchy/point_order.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "core/math/morton.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Index of the nearest of the six axes to the normal.
std::uint64_t facing(const Vec3& n) {
    const Vec3 a = glm::abs(n);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(2 * axis + (n[axis] < 0.0f));
}

/// Orders [first, last), which lies within a node of 2^level points, so that its children are the two sides
/// of a cut across the longest side.
void cut_at_medians(const Surfels& surfels, std::uint32_t* order, std::size_t first, std::size_t last,
                    std::uint32_t level) {
    if (level == 0 || last - first < 2) return;
    const std::size_t middle = ((first >> level) << level) + (std::size_t(1) << (level - 1));
    if (middle <= first || middle >= last) return cut_at_medians(surfels, order, first, last, level - 1);
    Bounds3 bounds;
    for (std::size_t i = first; i < last; ++i) bounds.extend(surfels.positions[order[i]]);
    const Vec3 size = bounds.diagonal();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::nth_element(order + first, order + middle, order + last, [&](std::uint32_t a, std::uint32_t b) {
        const float at_a = surfels.positions[a][axis], at_b = surfels.positions[b][axis];
        return at_a != at_b ? at_a < at_b : a < b;
    });
    const auto lower = [&] { cut_at_medians(surfels, order, first, middle, level - 1); };
    const auto upper = [&] { cut_at_medians(surfels, order, middle, last, level - 1); };
    if (last - first > 4096)
        tbb::parallel_invoke(lower, upper);
    else
        lower(), upper();
}

}  // namespace

std::vector<std::uint32_t> point_order(const Surfels& surfels) {
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
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && keyed[last].first >> 60 == keyed[first].first >> 60) ++last;
        cut_at_medians(surfels, order.data(), first, last, std::uint32_t(std::bit_width(order.size())));
    }
    return order;
}

}  // namespace mote::gathering
