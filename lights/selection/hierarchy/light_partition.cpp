#include "lights/selection/hierarchy/light_partition.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>
#include <span>

#include "core/objects/error.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int bins = 16;
constexpr double infinity_d = std::numeric_limits<double>::infinity();

Vec3 direction_of(const LightItem& item) {
    return {float(item.direction[0]), float(item.direction[1]), float(item.direction[2])};
}

struct Extent {
    Bounds3 positions, directions;
    double weight = 0.0;

    Extent() = default;
    explicit Extent(std::span<const LightItem> items) {
        for (const LightItem& item : items) add(item);
    }
    void add(const LightItem& item) {
        positions.extend(item.position), directions.extend(direction_of(item)), weight += double(item.weight);
    }
    void add(const Extent& other) {
        positions.extend(other.positions), directions.extend(other.directions), weight += other.weight;
    }
    /// Weight times size (Walter et al. 2005, Eq. 2): diagonal^2 + c^2 (1 - cos beta)^2, where 1 - cos beta
    /// is about an eighth of the squared diagonal of the directions. `c2`: c^2.
    double cost(double c2) const {
        if (positions.empty()) return 0.0;
        const Vec3d p(positions.diagonal()), d(directions.diagonal());
        const double bend = glm::dot(d, d) / (8.0 * 127.0 * 127.0);
        return weight * (glm::dot(p, p) + c2 * bend * bend);
    }
};

/// One side of the positions or of the directions, and where along it an item lies.
struct Axis {
    bool of_positions;
    int axis;
    float lower, per_length;

    float at(const LightItem& item) const {
        return of_positions ? item.position[axis] : float(item.direction[std::size_t(axis)]);
    }
    int bin(const LightItem& item) const {
        return std::clamp(int((at(item) - lower) * per_length), 0, bins - 1);
    }
};

std::optional<Axis> longest(const Bounds3& box, bool of_positions) {
    const Vec3 d = box.diagonal();
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const float per_length = float(double(bins) * (1.0 - 1e-6) / double(d[axis]));
    if (!(d[axis] > 0.0f) || !std::isfinite(per_length)) return std::nullopt;
    return Axis{of_positions, axis, box.lower[axis], per_length};
}

struct Cut {
    double cost;
    int bin;  ///< last of the left side
};

/// The best position of a cut along an axis; both sides hold lights.
Cut cheapest(std::span<const LightItem> items, const Axis& axis, double c2) {
    std::array<Extent, bins> parts{};
    for (const LightItem& item : items) parts[std::size_t(axis.bin(item))].add(item);
    std::array<double, bins> right{};
    Extent sum;
    for (std::size_t i = bins - 1; i > 0; --i) sum.add(parts[i]), right[i] = sum.cost(c2);
    Cut best{infinity_d, 0};
    Extent left;
    for (std::size_t i = 0; i + 1 < bins; ++i) {
        left.add(parts[i]);
        if (left.positions.empty()) continue;
        if (const double cost = left.cost(c2) + right[i + 1]; cost < best.cost) best = {cost, int(i)};
    }
    return best;
}

/// The multiple of `unit` next to n, between unit and what is below count.
std::uint32_t rounded(std::uint32_t n, std::uint32_t count, std::uint32_t unit) {
    return std::clamp((n + unit / 2) / unit * unit, unit, (count - 1) / unit * unit);
}

LightItem item_of(const LightLeaves& leaves, std::uint32_t light) {
    const LightNode leaf = leaves.leaf(light);
    LightItem item{0.5f * leaf.lower + 0.5f * leaf.upper, light, leaf.weight(), {}, leaf.kind};
    if (leaf.cos_angle > -1.0f)
        for (int k = 0; k < 3; ++k)
            item.direction[std::size_t(k)] = std::int8_t(std::lround(127.0f * leaf.axis()[k]));
    return item;
}

}  // namespace

LightPartition::LightPartition(const LightLeaves& leaves) : items_(leaves.size()) {
    tbb::parallel_for(std::size_t(0), items_.size(),
                      [&](std::size_t i) { items_[i] = item_of(leaves, std::uint32_t(i)); });
    for (const LightItem& item : items_)
        if (!(item.weight >= 0.0f && std::isfinite(item.weight)))
            throw InputError(
                fmt::format("light {} of a hierarchy has the energy {}", item.light, item.weight));
    std::erase_if(items_, [](const LightItem& item) { return item.weight == 0.0f; });
    auto begin = items_.begin();
    for (const LightKind kind : {LightKind::surface, LightKind::glossy, LightKind::volume})
        begin = std::partition(begin, items_.end(), [&](const LightItem& i) { return i.kind == kind; });
    Bounds3 all;
    for (const LightItem& item : items_) all.extend(item.position);
    const Vec3d d(all.empty() ? Vec3(0.0f) : all.diagonal());
    c2_ = 0.25 * glm::dot(d, d);  // half the diagonal of all lights
}

std::uint32_t LightPartition::split(std::uint32_t first, std::uint32_t count, std::uint32_t unit) {
    if (count == 2) return 1;
    const std::span items = std::span(items_).subspan(first, count);
    // Lights of different kinds have nothing in common; they stand apart from the beginning.
    const LightKind kind = items.front().kind;
    if (items.back().kind != kind)
        return std::uint32_t(
            std::find_if(items.begin(), items.end(), [&](const LightItem& i) { return i.kind != kind; }) -
            items.begin());
    if (unit >= count) unit = 1;
    const Extent all(items);
    Cut best{infinity_d, 0};
    std::optional<Axis> chosen;
    for (const bool of_positions : {true, false}) {
        const auto axis = longest(of_positions ? all.positions : all.directions, of_positions);
        if (!axis) continue;
        if (const Cut cut = cheapest(items, *axis, c2_); cut.cost < best.cost) best = cut, chosen = axis;
    }
    if (!chosen) return rounded(count / 2, count, unit);
    const auto middle = std::partition(items.begin(), items.end(),
                                       [&](const LightItem& i) { return chosen->bin(i) <= best.bin; });
    const auto n = std::uint32_t(middle - items.begin());
    if (n == 0 || n == count) return rounded(count / 2, count, unit);
    // Lights next to the cut move to its other side.
    const std::uint32_t wanted = rounded(n, count, unit);
    const auto less = [&](const LightItem& a, const LightItem& b) { return chosen->at(a) < chosen->at(b); };
    if (wanted != n)
        std::nth_element(wanted < n ? items.begin() : middle, items.begin() + wanted,
                         wanted < n ? middle : items.end(), less);
    return wanted;
}

}  // namespace mote::lights
