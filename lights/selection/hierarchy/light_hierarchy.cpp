#include "lights/selection/hierarchy/light_hierarchy.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "core/objects/error.h"
#include "lights/selection/hierarchy/light_partition.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t parallel_from = 4096;  // lights

/// Split of a cluster of n VPLs, which has n - 1 clusters of two or more in it: by their depth-first index.
struct Split {
    std::uint32_t left_count, left_nodes;
};

template <typename Left, typename Right>
void do_both(std::uint32_t lights, const Left& left, const Right& right) {
    if (lights < parallel_from)
        left(), right();
    else
        tbb::parallel_invoke(left, right);
}

class Builder {
  public:
    Builder(const LightLeaves& leaves, LightPartition& partition)
        : leaves_(leaves), partition_(partition), splits_(partition.size() - 1) {}

    /// Puts the lights of a cluster in order, whose number in the walk is given. Returns how many nodes it
    /// has.
    std::uint32_t split(std::uint32_t number, std::uint32_t first, std::uint32_t count) {
        if (count == 1) return 0;
        const std::uint32_t n = partition_.split(first, count);
        std::uint32_t left = 0, right = 0;
        do_both(
            count, [&] { left = split(number + 1, first, n); },
            [&] { right = split(number + n, first + n, count - n); });
        splits_[number] = {n, left};
        return LightCluster{0, first, count}.has_node() ? 1 + left + right : 0;
    }

    /// Writes the nodes of a cluster.
    LightNode build(std::uint32_t number, const LightCluster& c, std::vector<LightNode>& nodes) const {
        if (c.single()) return leaves_.leaf(partition_.item(c.first).light);
        const std::uint32_t n = splits_[number].left_count, left_nodes = splits_[number].left_nodes;
        LightNode a, b;
        do_both(
            c.count,
            [&] {
                a = build(number + 1, {c.node + 1, c.first, n}, nodes);
            },
            [&] {
                b = build(number + n, {c.node + 1 + left_nodes, c.first + n, c.count - n}, nodes);
            });
        LightNode node = united(a, b);
        node.left_count = n, node.left_nodes = left_nodes;
        if (c.has_node()) nodes[c.node] = node;
        return node;
    }

  private:
    const LightLeaves& leaves_;
    LightPartition& partition_;
    std::vector<Split> splits_;
};

}  // namespace

LightHierarchy::LightHierarchy(const LightLeaves& leaves, std::size_t max_bytes) : leaves_(&leaves) {
    const std::size_t needed = leaves.size() * (bytes_a_light + building_bytes_a_light);
    if (leaves.size() > (std::size_t(1) << 31) || needed > max_bytes)
        throw InputError(fmt::format(
            "a hierarchy over {} lights takes {:.3g} MB while it is built, and may take {:.3g} MB",
            leaves.size(), double(needed) * 1e-6, double(max_bytes) * 1e-6));
    LightPartition partition(leaves);
    if (partition.size() == 0) return;
    Builder builder(leaves, partition);
    nodes_.resize(builder.split(0, 0, partition.size()));
    builder.build(0, {0, 0, partition.size()}, nodes_);
    order_.resize(partition.size()), weights_.resize(partition.size());
    for (std::uint32_t i = 0; i < partition.size(); ++i)
        order_[i] = partition.item(i).light, weights_[i] = partition.item(i).weight;
    sums_.reserve(partition.size() / block + 1);
    double sum = 0.0;
    for (std::uint32_t i = 0; i < partition.size(); ++i) {
        if (i % block == 0) sums_.push_back(sum);
        sum += double(weights_[i]);
    }
}

std::uint32_t LightHierarchy::index_at(const LightCluster& c, double fraction) const {
    const std::uint32_t last = c.first + c.count - 1;
    double before = sums_[c.first / block];
    for (std::uint32_t i = c.first / block * block; i < c.first; ++i) before += double(weights_[i]);
    const double wanted = before + fraction * double(weight(c));
    const auto begin = sums_.begin();
    const auto above = std::upper_bound(begin + c.first / block + 1, begin + last / block + 1, wanted) - 1;
    std::uint32_t index = c.first;
    if (const auto first = std::uint32_t(above - begin) * block; first > c.first)
        index = first, before = *above;
    for (; index < last; ++index) {
        before += double(weights_[index]);
        if (before > wanted) break;
    }
    return index;
}

}  // namespace mote::lights
