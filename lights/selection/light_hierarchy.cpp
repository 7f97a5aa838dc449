#include "lights/selection/light_hierarchy.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>

#include "core/math/random.h"
#include "core/objects/error.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int bins = 16;
constexpr std::uint32_t parallel_from = 4096;  // lights

/// A light on its way to its place.
struct Item {
    Vec3 position;
    std::uint32_t light;
    Vec3 direction;  ///< zero where it has none
    float weight;
    LightKind kind;
};

struct Extent {
    Bounds3 positions, directions;
    double weight = 0.0;

    void add(const Item& item) {
        positions.extend(item.position), directions.extend(item.direction), weight += double(item.weight);
    }
    void add(const Extent& other) {
        positions.extend(other.positions), directions.extend(other.directions), weight += other.weight;
    }
    /// Weight times size (Walter et al. 2005, Eq. 2): diagonal^2 + c^2 (1 - cos beta)^2, where 1 - cos beta
    /// is about an eighth of the squared diagonal of the directions. `c2`: c^2.
    double cost(double c2) const {
        if (positions.empty()) return 0.0;
        const Vec3d p(positions.diagonal()), d(directions.diagonal());
        return weight * (glm::dot(p, p) + c2 * sqr(glm::dot(d, d) / 8.0));
    }
};

/// One side of the positions or of the directions, and where along it an item lies.
struct Axis {
    bool of_positions;
    int axis;
    float lower, per_length;

    int bin(const Item& item) const {
        const float value = (of_positions ? item.position : item.direction)[axis];
        return std::clamp(int((value - lower) * per_length), 0, bins - 1);
    }
};

class Builder {
  public:
    Builder(const LightLeaves& leaves, std::uint64_t seed, std::vector<Item>& items,
            std::vector<LightNode>& nodes)
        : leaves_(leaves), seed_(seed), items_(items), nodes_(nodes) {
        const Extent all = extent({0, 0, std::uint32_t(items.size())});
        const Vec3d d = Vec3d(all.positions.empty() ? Vec3(0.0f) : all.positions.diagonal());
        c2_ = 0.25 * glm::dot(d, d);  // half the diagonal of all lights
    }

    /// Puts the items of a group in order and writes its nodes.
    LightNode build(const LightCluster& c) {
        if (c.single()) {
            LightNode leaf = leaves_.leaf(items_[c.first].light);
            leaf.representative = c.first;
            return leaf;
        }
        const std::uint32_t n = split(c);
        const LightCluster left{c.node + 1, c.first, n}, right{c.node + n, c.first + n, c.count - n};
        LightNode a, b;
        if (c.count < parallel_from)
            a = build(left), b = build(right);
        else
            tbb::parallel_invoke([&] { a = build(left); }, [&] { b = build(right); });
        LightNode& node = nodes_[c.node];
        node = united(a, b);
        node.left_count = n;
        const float u = Rng(hash_keys(seed_, c.node, c.count)).next_float();
        node.representative = double(u) * (double(a.weight()) + double(b.weight())) < double(a.weight())
                                  ? a.representative
                                  : b.representative;
        return node;
    }

  private:
    Extent extent(const LightCluster& c) const {
        Extent e;
        for (std::uint32_t i = c.first; i < c.first + c.count; ++i) e.add(items_[i]);
        return e;
    }

    /// Puts lights of the left part before those of the right one. Returns how many they are.
    std::uint32_t split(const LightCluster& c) {
        if (c.count == 2) return 1;
        const auto begin = items_.begin() + c.first, end = begin + c.count;
        const auto parted = [&](const auto& is_left) {
            return std::uint32_t(std::partition(begin, end, is_left) - begin);
        };
        const auto useful = [&](std::uint32_t n) { return n > 0 && n < c.count; };
        // Lights of different kinds have nothing in common; they stand apart from the beginning.
        const LightKind kind = begin->kind;
        if ((end - 1)->kind != kind)
            return std::uint32_t(std::find_if(begin, end, [&](const Item& i) { return i.kind != kind; }) -
                                 begin);
        const Extent all = extent(c);
        double least = infinity_d;
        std::optional<Axis> best;
        int last = 0;  // bin of the left part
        for (const bool of_positions : {true, false}) {
            const auto axis = longest(of_positions ? all.positions : all.directions, of_positions);
            if (!axis) continue;
            const auto [cost, bin] = cheapest(c, *axis);
            if (cost < least) least = cost, best = axis, last = bin;
        }
        if (best) {
            const std::uint32_t n = parted([&](const Item& i) { return best->bin(i) <= last; });
            if (useful(n)) return n;
        }
        return c.count / 2;
    }

    static std::optional<Axis> longest(const Bounds3& box, bool of_positions) {
        const Vec3 d = box.diagonal();
        const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
        const float per_length = float(double(bins) * (1.0 - 1e-6) / double(d[axis]));
        if (!(d[axis] > 0.0f) || !std::isfinite(per_length)) return std::nullopt;
        return Axis{of_positions, axis, box.lower[axis], per_length};
    }

    struct Cut {
        double cost;
        int bin;
    };
    /// The best place to cut along an axis; both parts hold lights.
    Cut cheapest(const LightCluster& c, const Axis& axis) const {
        std::array<Extent, bins> parts{};
        for (std::uint32_t i = c.first; i < c.first + c.count; ++i)
            parts[std::size_t(axis.bin(items_[i]))].add(items_[i]);
        std::array<double, bins> right{};
        Extent sum;
        for (std::size_t i = bins - 1; i > 0; --i) sum.add(parts[i]), right[i] = sum.cost(c2_);
        Cut best{infinity_d, 0};
        Extent left;
        for (std::size_t i = 0; i + 1 < bins; ++i) {
            left.add(parts[i]);
            if (left.positions.empty()) continue;
            if (const double cost = left.cost(c2_) + right[i + 1]; cost < best.cost) best = {cost, int(i)};
        }
        return best;
    }

    static constexpr double infinity_d = std::numeric_limits<double>::infinity();
    const LightLeaves& leaves_;
    std::uint64_t seed_;
    std::vector<Item>& items_;
    std::vector<LightNode>& nodes_;
    double c2_ = 0.0;
};

Item item_of(const LightLeaves& leaves, std::uint32_t light) {
    const LightNode leaf = leaves.leaf(light);
    const bool directed = leaf.cos_angle > -1.0f;
    return {0.5f * leaf.lower + 0.5f * leaf.upper, light, directed ? leaf.axis() : Vec3(0.0f), leaf.weight(),
            leaf.kind};
}

std::vector<Item> items_of(const LightLeaves& leaves) {
    std::vector<Item> items(leaves.size());
    tbb::parallel_for(std::size_t(0), items.size(),
                      [&](std::size_t i) { items[i] = item_of(leaves, std::uint32_t(i)); });
    for (const Item& item : items)
        if (!(item.weight >= 0.0f && std::isfinite(item.weight)))
            throw InputError(
                fmt::format("light {} of a hierarchy has the energy {}", item.light, item.weight));
    std::erase_if(items, [](const Item& item) { return item.weight == 0.0f; });
    std::stable_sort(items.begin(), items.end(),
                     [](const Item& a, const Item& b) { return a.kind < b.kind; });
    return items;
}

}  // namespace

LightHierarchy::LightHierarchy(const LightLeaves& leaves, std::uint64_t seed, std::size_t max_bytes)
    : leaves_(&leaves) {
    const std::size_t needed = leaves.size() * (bytes_a_light + sizeof(Item));
    if (leaves.size() > (std::size_t(1) << 31) || needed > max_bytes)
        throw InputError(fmt::format(
            "a hierarchy over {} lights takes {:.3g} MB while it is built, and may take {:.3g} MB",
            leaves.size(), double(needed) * 1e-6, double(max_bytes) * 1e-6));
    std::vector<Item> items = items_of(leaves);
    if (items.empty()) return;
    nodes_.resize(items.size() - 1);
    Builder(leaves, seed, items, nodes_).build({0, 0, std::uint32_t(items.size())});
    order_.resize(items.size()), weights_.resize(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) order_[i] = items[i].light, weights_[i] = items[i].weight;
}

}  // namespace mote::lights
