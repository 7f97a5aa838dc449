// What estimates found out about groups of lights: what share of what was expected arrived, and how much that
// differs from light to light.
//
// A group that stood for itself at a tile says at the next tile whether it is worth parting: what is in
// shadow altogether, or sends far less than its place lets expect, is not. That moves cuts, not estimates:
// who stands for a group is drawn anew, and traced.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace mote::lights {

/// Estimates by one light of a group, each over what the group was expected to send.
struct SeenCluster {
    float count = 0.0f, sum = 0.0f, squares = 0.0f;

    void add(float share) { count += 1.0f, sum += share, squares += share * share; }
    /// With a light or two of a group that nothing is known of.
    float mean() const { return (sum + prior_count * prior_mean) / (count + prior_count); }
    /// Of one light's estimate, over the square of what is expected.
    float variance() const {
        const float square = (squares + prior_count * prior_square) / (count + prior_count);
        return std::max(square - mean() * mean(), least * square);
    }
    /// What a part of the group may be like: half as certain.
    SeenCluster of_part() const { return {0.5f * count, 0.5f * sum, 0.5f * squares}; }

  private:
    static constexpr float prior_count = 1.0f, prior_mean = 0.4f, prior_square = 0.3f, least = 0.05f;
};

/// Of the nodes of a hierarchy, by kind of receivers. A table in which later ones overwrite earlier ones.
class SeenClusters {
  public:
    /// Nothing where it was not seen.
    const SeenCluster* find(std::uint32_t node, std::uint32_t kind) const {
        if (items_.empty()) return nullptr;
        const Item& item = items_[place(node, kind)];
        return item.key == key(node, kind) ? &item.seen : nullptr;
    }
    void set(std::uint32_t node, std::uint32_t kind, const SeenCluster& seen) {
        if (items_.empty()) items_.resize(size);
        items_[place(node, kind)] = {key(node, kind), seen};
    }
    bool empty() const { return items_.empty(); }

  private:
    static constexpr std::size_t size = 1 << 13;
    struct Item {
        std::uint64_t key = 0;
        SeenCluster seen;
    };
    static std::uint64_t key(std::uint32_t node, std::uint32_t kind) {
        return (std::uint64_t(node) << 2 | kind) + 1;
    }
    static std::size_t place(std::uint32_t node, std::uint32_t kind) {
        return std::size_t((key(node, kind) * 0x9e3779b97f4a7c15ull) >> 51);
    }
    std::vector<Item> items_;
};

}  // namespace mote::lights
