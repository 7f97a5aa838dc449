// Statistics of estimates by cluster of VPLs: their mean and mean square over the cluster's importance.
//
// Those of previous tiles show whether a cluster is worth splitting: one that is occluded altogether, or
// sends far less than its importance, is not. That moves cuts, not estimates: representatives are sampled
// anew, and traced.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace mote::lights {

/// Estimates by one VPL of a cluster, each over the cluster's importance.
struct ClusterStatistics {
    float count = 0.0f, sum = 0.0f, squares = 0.0f;

    void add(float ratio) { count += 1.0f, sum += ratio, squares += ratio * ratio; }
    float mean() const { return (sum + prior_count * prior_mean) / (count + prior_count); }
    /// Variance of one VPL's estimate, over the square of the importance.
    float variance() const {
        const float square = (squares + prior_count * prior_square) / (count + prior_count);
        return std::max(square - mean() * mean(), min_variance * square);
    }
    /// Statistics that a child starts from: half as certain.
    ClusterStatistics of_child() const { return {0.5f * count, 0.5f * sum, 0.5f * squares}; }

  private:
    static constexpr float prior_count = 1.0f, prior_mean = 0.4f, prior_square = 0.3f, min_variance = 0.05f;
};

/// Statistics by node of a hierarchy and kind of receivers: a hash table in which later entries overwrite
/// earlier ones.
class ClusterStatisticsTable {
  public:
    /// Null where there are none.
    const ClusterStatistics* find(std::uint32_t node, std::uint32_t kind) const {
        if (items_.empty()) return nullptr;
        const Item& item = items_[slot(node, kind)];
        return item.key == key(node, kind) ? &item.statistics : nullptr;
    }
    void set(std::uint32_t node, std::uint32_t kind, const ClusterStatistics& statistics) {
        if (items_.empty()) items_.resize(size);
        items_[slot(node, kind)] = {key(node, kind), statistics};
    }
    bool empty() const { return items_.empty(); }

  private:
    static constexpr std::size_t size = 1 << 13;
    struct Item {
        std::uint64_t key = 0;
        ClusterStatistics statistics;
    };
    static std::uint64_t key(std::uint32_t node, std::uint32_t kind) {
        return (std::uint64_t(node) << 2 | kind) + 1;
    }
    static std::size_t slot(std::uint32_t node, std::uint32_t kind) {
        return std::size_t((key(node, kind) * 0x9e3779b97f4a7c15ull) >> 51);
    }
    std::vector<Item> items_;
};

}  // namespace mote::lights
