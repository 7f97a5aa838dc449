#include "lights/selection/light_sampler.h"

#include <algorithm>

namespace mote::lights {

using namespace core;

namespace {

/// In [0, 1), in steps of 2^-53: shares far below 2^-24 are drawn as often as they say.
double next_double(Rng& rng) {
    const std::uint64_t high = rng.next_u32();
    return double((high << 32 | rng.next_u32()) >> 11) * 0x1p-53;
}

/// What each part is expected to send, and before it all parts to its left; not all 0.
struct Shares {
    std::array<double, most_parts + 1> before;

    Shares(const LightTreeNode& node, const ReceiverGroups& receivers, float bound) {
        const auto expected = expected_light(LightParts(node), receivers, bound);
        if (!add(expected.data())) add(node.share);
    }
    double of(int i) const { return (at(i + 1) - at(i)) / before[most_parts]; }
    double at(int i) const { return before[std::size_t(i)]; }

  private:
    bool add(const float* values) {
        before[0] = 0.0;
        for (std::size_t i = 0; i < most_parts; ++i) before[i + 1] = before[i] + double(values[i]);
        return before[most_parts] > 0.0;
    }
};

/// A single light cannot be parted: it stands last.
bool less(const LightSampler::Group& a, const LightSampler::Group& b) {
    return a.is_light != b.is_light ? a.is_light : a.expected < b.expected;
}

}  // namespace

std::vector<double> probabilities(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                                  std::size_t lights) {
    std::vector<double> p(lights, 0.0);
    std::vector<std::pair<const LightTreeNode*, double>> tasks;
    if (!tree.empty()) tasks.emplace_back(&tree.root(), 1.0);
    while (!tasks.empty()) {
        const auto [node, reached] = tasks.back();
        tasks.pop_back();
        const Shares shares(*node, receivers, bound);
        for (int i = 0; i < node->count; ++i)
            if (node->leaf(i))
                p[node->child[i]] = reached * shares.of(i);
            else
                tasks.emplace_back(&tree.node(node->child[i]), reached * shares.of(i));
    }
    return p;
}

void LightSampler::draw(const LightTree& tree, const ReceiverGroups& receivers, float bound, double scale,
                        Rng& rng) {
    // One level after the other, so that nodes arrive from memory while others are looked at.
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
        const Task task = tasks_[t];
        const LightTreeNode& node = tree.node(task.node);
        const Shares shares(node, receivers, bound);
        // Draws are points k + u; those within count times the share of a part are its own.
        const double u = next_double(rng), per_value = double(task.count) / shares.at(most_parts);
        auto done = std::uint32_t(0);
        for (int i = 0; i < node.count && done < task.count; ++i) {
            const auto end = std::min(std::uint32_t(shares.at(i + 1) * per_value + u), task.count);
            if (end == done) continue;
            const std::uint32_t count = end - done;
            const double p = task.p * shares.of(i);
            if (node.leaf(i)) {
                drawn_.push_back({node.child[i], float(double(count) * scale / p)});
            } else {
                tree.prefetch(node.child[i]);
                tasks_.push_back({node.child[i], count, p});
            }
            done = end;
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_tree(const LightTree& tree, const ReceiverGroups& receivers,
                                                   float bound, std::uint32_t n, Rng& rng) {
    drawn_.clear();
    if (tree.empty() || receivers.empty()) return drawn_;
    tasks_.assign(1, {tree.root_index(), n, 1.0});
    draw(tree, receivers, bound, 1.0 / double(n), rng);
    return drawn_;
}

/// Adds a group without the parts at its ends that send nothing, and nothing where none sends any.
void LightSampler::add_group(const LightTree& tree, Group g) {
    const Values& values = values_[g.values];
    const auto dark = [&](int i) { return !(values[std::size_t(i)] > 0.0f); };
    while (g.first < g.last && dark(g.first)) ++g.first;
    while (g.first < g.last && dark(g.last - 1)) --g.last;
    if (g.first == g.last) return;
    g.is_light = g.last - g.first == 1 && tree.node(g.node).leaf(g.first);
    g.expected = 0.0;
    for (int i = g.first; i < g.last; ++i) g.expected += g.energy * double(values[std::size_t(i)]);
    cut_.push_back(g);
    std::push_heap(cut_.begin(), cut_.end(), &less);
}

void LightSampler::make_cut(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                            std::uint32_t n) {
    cut_.clear(), values_.clear();
    const auto add_node = [&](std::uint32_t index, double energy) {
        const LightTreeNode& node = tree.node(index);
        values_.push_back(expected_light(LightParts(node), receivers, bound));
        add_group(tree, {index, std::uint32_t(values_.size() - 1), 0, node.count, false, energy, 0.0});
    };
    add_node(tree.root_index(), 1.0);
    while (!cut_.empty() && !cut_.front().is_light && cut_.size() < n) {
        std::pop_heap(cut_.begin(), cut_.end(), &less);
        const Group group = cut_.back();
        cut_.pop_back();
        const LightTreeNode& node = tree.node(group.node);
        if (group.last - group.first == 1) {
            const int i = group.first;
            add_node(node.child[i], group.energy * double(node.share[i]));
            continue;
        }
        // Halves as like as can be.
        int middle = group.first + 1;
        double left = 0.0, most = -1.0;
        for (int i = group.first; i + 1 < group.last; ++i) {
            left += group.energy * double(values_[group.values][std::size_t(i)]);
            if (const double lesser = std::min(left, group.expected - left); lesser > most)
                most = lesser, middle = i + 1;
        }
        Group half = group;
        half.last = middle, add_group(tree, half);
        half.first = middle, half.last = group.last, add_group(tree, half);
    }
}

/// Adds a light of the group, or a task for it.
void LightSampler::draw_from(const LightTree& tree, const Group& group, Rng& rng) {
    const LightTreeNode& node = tree.node(group.node);
    const Values& values = values_[group.values];
    double sum = 0.0, before = 0.0;
    for (int i = group.first; i < group.last; ++i) sum += double(values[std::size_t(i)]);
    const double u = next_double(rng) * sum;
    int i = group.first;
    while (i + 1 < group.last && !(u < before + double(values[std::size_t(i)])))
        before += double(values[std::size_t(i++)]);
    const double p = double(values[std::size_t(i)]) / sum;
    if (node.leaf(i)) {
        drawn_.push_back({node.child[i], float(1.0 / p)});
    } else {
        tree.prefetch(node.child[i]);
        tasks_.push_back({node.child[i], 1, p});
    }
}

std::span<const WeightedVpl> LightSampler::by_cut(const LightTree& tree, const ReceiverGroups& receivers,
                                                  float bound, std::uint32_t n, Rng& rng) {
    drawn_.clear(), cut_.clear();
    if (tree.empty() || receivers.empty()) return drawn_;
    make_cut(tree, receivers, bound, n);
    tasks_.clear();
    for (const Group& group : cut_) draw_from(tree, group, rng);
    draw(tree, receivers, bound, 1.0, rng);
    return drawn_;
}

}  // namespace mote::lights
