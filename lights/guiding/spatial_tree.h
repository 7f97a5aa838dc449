// A binary tree over space whose leaves learn from the samples that fall into them.
//
// A leaf is split where it has received more than so many samples: at their mean, along the axis in which
// they vary most. Its halves inherit what it learned, a share of it each (Müller et al. 2017). The result
// depends on the samples and their order alone, not on threads.
#pragma once

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/objects/memory_budget.h"

namespace mote::lights {

/// Leaf needs a type Sample with a position; Leaf(pivot), add(span of samples), scale(factor), samples(),
/// moved_to(pivot), and `inherited`, the share that each half of a leaf takes over.
template <typename Leaf>
class SpatialTree {
  public:
    using Sample = typename Leaf::Sample;  ///< of the leaves

    /// Leaves with more than `leaf_samples` samples are split, as long as all fit into `bytes`. Throws
    /// OutOfMemory, naming the tree `what`, where these are not available.
    SpatialTree(double leaf_samples, double bytes, const core::MemoryBudget& memory, const char* what)
        : leaf_samples_(leaf_samples),
          max_leaves_(std::max(std::size_t(1), std::size_t(bytes / (sizeof(Leaf) + 2 * sizeof(Node))))),
          nodes_(1) {
        memory.require(bytes, what);
        leaves_.reserve(max_leaves_), nodes_.reserve(2 * max_leaves_);
    }

    /// A batch of samples, in their order; it is sorted by leaves.
    void add(std::vector<Sample>& samples) {
        if (samples.empty()) return;
        if (leaves_.empty()) leaves_.emplace_back(core::Vec3(Spread(samples).mean));
        std::vector<Share> shares;
        distribute(0, samples, 0, samples.size(), shares);
        tbb::parallel_for_each(shares, [&](const Share& s) {
            leaves_[s.leaf].add(std::span(samples).subspan(s.begin, s.end - s.begin));
        });
    }
    /// All that was learned so far counts this much.
    void scale(double factor) {
        for (Leaf& leaf : leaves_) leaf.scale(factor);
    }

    const std::vector<Leaf>& leaves() const { return leaves_; }  ///< all of them; none before a sample
    /// Index in leaves().
    std::size_t leaf_of(const core::Vec3& position) const {
        // Vec3 finds an index by branches.
        const float coordinates[3] = {position.x, position.y, position.z};
        const Node* node = nodes_.data();
        while (node->axis >= 0)
            node = &nodes_[node->next + (coordinates[node->axis] < node->plane ? 0u : 1u)];
        return node->next;
    }

  private:
    struct Node {
        float plane = 0.0f;      ///< what lies below goes to the first child
        std::int32_t axis = -1;  ///< -1: a leaf
        std::uint32_t next = 0;  ///< the first child, the second behind it; of a leaf: its index
    };
    /// Samples of a batch, by their indices, and the leaf in which they lie.
    struct Share {
        std::uint32_t leaf;
        std::size_t begin, end;
    };
    /// Mean and variance of positions, which may lie far from the origin.
    struct Spread {
        core::Vec3d mean{0.0}, variance{0.0};
        explicit Spread(std::span<const Sample> samples) {
            const core::Vec3d origin(samples.front().position);
            core::Vec3d squares(0.0);
            for (const Sample& s : samples) {
                const core::Vec3d d = core::Vec3d(s.position) - origin;
                mean += d, squares += d * d;
            }
            mean /= double(samples.size());
            variance = squares / double(samples.size()) - mean * mean;
            mean += origin;
        }
    };
    void distribute(std::uint32_t node, std::vector<Sample>& samples, std::size_t begin, std::size_t end,
                    std::vector<Share>& shares);
    void split(std::uint32_t node, std::span<Sample> samples);

    double leaf_samples_;
    std::size_t max_leaves_;
    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
};

template <typename Leaf>
void SpatialTree<Leaf>::distribute(std::uint32_t node, std::vector<Sample>& samples, std::size_t begin,
                                   std::size_t end, std::vector<Share>& shares) {
    if (begin == end) return;
    if (nodes_[node].axis < 0 && leaves_.size() < max_leaves_ &&
        leaves_[nodes_[node].next].samples() + double(end - begin) > leaf_samples_)
        split(node, std::span(samples).subspan(begin, end - begin));
    const Node here = nodes_[node];
    if (here.axis < 0) {
        shares.push_back({here.next, begin, end});
        return;
    }
    const auto first = samples.begin() + std::ptrdiff_t(begin), last = samples.begin() + std::ptrdiff_t(end);
    const auto below = [&](const Sample& s) { return s.position[here.axis] < here.plane; };
    const auto middle = std::size_t(std::stable_partition(first, last, below) - samples.begin());
    distribute(here.next, samples, begin, middle, shares);
    distribute(here.next + 1, samples, middle, end, shares);
}

/// Leaves the node as it is where the samples do not lie apart.
template <typename Leaf>
void SpatialTree<Leaf>::split(std::uint32_t node, std::span<Sample> samples) {
    const Spread spread(samples);
    int axis = spread.variance.y > spread.variance.x ? 1 : 0;
    if (spread.variance.z > spread.variance[axis]) axis = 2;
    const auto plane = float(spread.mean[axis]);
    const auto middle = std::stable_partition(samples.begin(), samples.end(),
                                              [&](const Sample& s) { return s.position[axis] < plane; });
    const std::span below(samples.begin(), middle), above(middle, samples.end());
    if (below.empty() || above.empty()) return;

    const std::uint32_t leaf = nodes_[node].next, children = std::uint32_t(nodes_.size());
    Leaf half = leaves_[leaf];
    half.scale(Leaf::inherited);
    leaves_[leaf] = half.moved_to(core::Vec3(Spread(below).mean));
    leaves_.push_back(half.moved_to(core::Vec3(Spread(above).mean)));
    nodes_[node] = {plane, axis, children};
    nodes_.push_back({0.0f, -1, leaf});
    nodes_.push_back({0.0f, -1, std::uint32_t(leaves_.size() - 1)});
}

}  // namespace mote::lights
