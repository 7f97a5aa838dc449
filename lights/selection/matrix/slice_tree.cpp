#include "lights/selection/matrix/slice_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/math/bounds.h"

namespace mote::lights {

using namespace core;

namespace {

/// The element that would be the n-th if a range were sorted by value.
template <typename Value>
std::span<std::uint32_t>::iterator nth(std::span<std::uint32_t> part, std::size_t n, const Value& value) {
    const auto at = part.begin() + std::ptrdiff_t(n);
    std::nth_element(part.begin(), at, part.end(), [&](std::uint32_t i, std::uint32_t j) {
        return value(i) != value(j) ? value(i) < value(j) : i < j;
    });
    return at;
}

}  // namespace

SliceTree::SliceTree(std::span<const SlicePoint> sites, std::size_t groups) {
    if (sites.empty() || groups == 0) return;
    Bounds3 bounds;
    for (const SlicePoint& site : sites) bounds.extend(site.position);
    lower_ = bounds.lower;
    const float extent = max_component(bounds.diagonal());
    scale_ = extent > 0.0f ? 1.0f / extent : 0.0f;
    std::vector<Point> points;
    for (const SlicePoint& site : sites) points.push_back(point(site));
    order_.resize(sites.size());
    std::iota(order_.begin(), order_.end(), 0u);
    first_.push_back(0);
    build(points, 0, sites.size(), std::min(groups, sites.size()));
}

SliceTree::Point SliceTree::point(const SlicePoint& site) const {
    const Vec3 p = scale_ * (site.position - lower_), n = 0.25f * site.normal;
    return {p.x, p.y, p.z, n.x, n.y, n.z, site.normal == Vec3(0.0f) ? 1.0f : 0.0f};
}

std::uint32_t SliceTree::close(std::uint32_t node, std::size_t last) {
    nodes_[node].left = std::uint32_t(first_.size() - 1);
    first_.push_back(last);
    return node;
}

std::uint32_t SliceTree::build(std::span<const Point> points, std::size_t first, std::size_t last,
                               std::size_t groups) {
    const auto index = std::uint32_t(nodes_.size());
    nodes_.emplace_back();
    if (groups == 1) return close(index, last);
    const double count = double(last - first);
    std::size_t axis = 0;
    double most = -1.0;
    for (std::size_t a = 0; a < Point().size(); ++a) {
        double sum = 0.0, squares = 0.0;
        for (std::size_t i = first; i < last; ++i) {
            const double x = double(points[order_[i]][a]);
            sum += x, squares += x * x;
        }
        const double variance = squares / count - (sum / count) * (sum / count);
        if (variance > most) most = variance, axis = a;
    }
    const auto value = [&](std::uint32_t i) { return points[i][axis]; };
    const std::span<std::uint32_t> part = std::span(order_).subspan(first, last - first);
    const float median = value(*nth(part, groups / 2 * part.size() / groups, value));
    // Points of one coordinate stay together: below the median, or where there are none, up to it.
    float cut = median;
    auto middle = std::partition(part.begin(), part.end(), [&](std::uint32_t i) { return value(i) < cut; });
    if (middle == part.begin()) {
        // Not a denormal number, which threads that flush those to zero would not distinguish from a median
        // of 0.
        cut = std::nextafter(median, infinity);
        if (std::fabs(cut) < std::numeric_limits<float>::min()) cut = std::numeric_limits<float>::min();
        middle = std::partition(part.begin(), part.end(), [&](std::uint32_t i) { return value(i) < cut; });
    }
    const auto left_count = std::size_t(middle - part.begin()), right_count = part.size() - left_count;
    if (left_count == 0 || right_count == 0) return close(index, last);  // all at one position
    const std::size_t on_left = (groups * left_count + part.size() / 2) / part.size();
    const std::size_t left_groups = std::clamp(on_left, std::size_t(1), groups - 1);
    nodes_[index].axis = int(axis), nodes_[index].cut = cut;
    const std::uint32_t left = build(points, first, first + left_count, std::min(left_groups, left_count));
    const std::uint32_t right =
        build(points, first + left_count, last, std::min(groups - left_groups, right_count));
    nodes_[index].left = left, nodes_[index].right = right;
    return index;
}

std::size_t SliceTree::find(const SlicePoint& site) const {
    const Point p = point(site);
    const Node* node = &nodes_.front();
    while (node->axis >= 0) node = &nodes_[p[std::size_t(node->axis)] < node->cut ? node->left : node->right];
    return node->left;
}

}  // namespace mote::lights
