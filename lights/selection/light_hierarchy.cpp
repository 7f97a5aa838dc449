#include "lights/selection/light_hierarchy.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "lights/selection/light_partition.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t parallel_from = 4096;  // lights

class Builder {
  public:
    Builder(const LightLeaves& leaves, std::uint64_t seed, LightPartition& partition,
            std::vector<LightNode>& nodes)
        : leaves_(leaves), seed_(seed), partition_(partition), nodes_(nodes) {}

    /// Puts the items of a group in order and writes its nodes.
    LightNode build(const LightCluster& c) {
        if (c.single()) {
            LightNode leaf = leaves_.leaf(partition_.item(c.first).light);
            leaf.representative = c.first;
            return leaf;
        }
        const std::uint32_t n = partition_.split(c.first, c.count);
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
    const LightLeaves& leaves_;
    std::uint64_t seed_;
    LightPartition& partition_;
    std::vector<LightNode>& nodes_;
};

}  // namespace

LightHierarchy::LightHierarchy(const LightLeaves& leaves, std::uint64_t seed, std::size_t max_bytes)
    : leaves_(&leaves) {
    const std::size_t needed = leaves.size() * (bytes_a_light + sizeof(LightItem));
    if (leaves.size() > (std::size_t(1) << 31) || needed > max_bytes)
        throw InputError(fmt::format(
            "a hierarchy over {} lights takes {:.3g} MB while it is built, and may take {:.3g} MB",
            leaves.size(), double(needed) * 1e-6, double(max_bytes) * 1e-6));
    LightPartition partition(leaves);
    if (partition.size() == 0) return;
    nodes_.resize(partition.size() - 1);
    Builder(leaves, seed, partition, nodes_).build({0, 0, partition.size()});
    order_.resize(partition.size()), weights_.resize(partition.size());
    for (std::uint32_t i = 0; i < partition.size(); ++i)
        order_[i] = partition.item(i).light, weights_[i] = partition.item(i).weight;
    double sum = 0.0;
    for (std::uint32_t i = 0; i < partition.size(); ++i) {
        if (i % block == 0) sums_.push_back(sum);
        sum += double(weights_[i]);
    }
}

std::uint32_t LightHierarchy::place_at(const LightCluster& c, double share) const {
    const std::uint32_t last = c.first + c.count - 1;
    double before = sums_[c.first / block];
    for (std::uint32_t i = c.first / block * block; i < c.first; ++i) before += double(weights_[i]);
    const double wanted = before + share * double(weight(c));
    const auto begin = sums_.begin();
    const auto above = std::upper_bound(begin + c.first / block + 1, begin + last / block + 1, wanted) - 1;
    std::uint32_t place = c.first;
    if (const auto first = std::uint32_t(above - begin) * block; first > c.first)
        place = first, before = *above;
    for (; place < last; ++place) {
        before += double(weights_[place]);
        if (before > wanted) break;
    }
    return place;
}

}  // namespace mote::lights
