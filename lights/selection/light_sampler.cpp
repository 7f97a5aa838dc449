#include "lights/selection/light_sampler.h"

#include "core/math/vectorize.h"

namespace mote::lights {

using namespace core;

namespace {

/// Below infinity, so that shares stay numbers: a receiver may stand on a light.
double expected_sum(const LightNode& node, const ReceiverBounds& receivers, float bound) {
    const LaneValues lanes = expected_light(node, receivers, bound);
    alignas(64) float sums[8];
    for (std::size_t i = 0; i < 8; ++i)
        sums[i] = core::min_of(lanes.value[i], 1e36f) + core::min_of(lanes.value[i + 8], 1e36f);
    return double((sums[0] + sums[1]) + (sums[2] + sums[3]) + (sums[4] + sums[5]) + (sums[6] + sums[7]));
}

}  // namespace

double left_share(const LightHierarchy& lights, const LightCluster& group, const ReceiverBounds& receivers,
                  float bound) {
    const LightCluster left = lights.left(group), right = lights.right(group);
    double l = 0.0, r = 0.0;
    // The last choice, of two lights, goes by energy: what they are otherwise would take as long as two
    // levels.
    if (!left.single() || !right.single())
        l = expected_sum(lights.node(left), receivers, bound),
        r = expected_sum(lights.node(right), receivers, bound);
    if (!(l + r > 0.0)) l = double(lights.weight(left)), r = double(lights.weight(right));
    return l / (l + r);
}

std::vector<double> probabilities(const LightHierarchy& lights, const LightCluster& group,
                                  const ReceiverBounds& receivers, float bound) {
    std::vector<double> p(lights.size(), 0.0);
    std::vector<std::pair<LightCluster, double>> tasks{{group, 1.0}};
    while (!tasks.empty()) {
        const auto [c, reached] = tasks.back();
        tasks.pop_back();
        if (c.single()) {
            p[c.first] = reached;
            continue;
        }
        const double share = left_share(lights, c, receivers, bound);
        tasks.emplace_back(lights.left(c), reached * share);
        tasks.emplace_back(lights.right(c), reached * (1.0 - share));
    }
    return p;
}

void LightSampler::draw(const LightHierarchy& lights, const ReceiverBounds& receivers, float bound,
                        double scale) {
    // One level after the other, so that nodes arrive from memory while others are looked at.
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
        const Task task = tasks_[t];
        if (task.group.single()) {
            const double draws = double(task.last - task.first);
            drawn_.push_back({lights.light_at(task.group.first), float(draws * scale / task.p)});
            continue;
        }
        // Numbers stay in order, those of the left part first; each part makes [0, 1) of its share.
        const double share = left_share(lights, task.group, receivers, bound);
        std::size_t middle = task.first;
        while (middle < task.last && numbers_[middle] < share) numbers_[middle++] /= share;
        for (std::size_t i = middle; i < task.last; ++i)
            numbers_[i] = std::min((numbers_[i] - share) / (1.0 - share), 1.0 - 0x1p-53);
        const LightCluster left = lights.left(task.group), right = lights.right(task.group);
        if (task.first < middle) {
            lights.prefetch(left);
            tasks_.push_back({left, task.p * share, task.first, middle});
        }
        if (middle < task.last) {
            lights.prefetch(right);
            tasks_.push_back({right, task.p * (1.0 - share), middle, task.last});
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_tree(const LightHierarchy& lights,
                                                   const ReceiverBounds& receivers, float bound,
                                                   std::uint32_t n, Rng& rng) {
    drawn_.clear();
    if (lights.empty() || !receivers.any_active) return drawn_;
    numbers_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) numbers_[i] = (double(i) + double(rng.next_float())) / double(n);
    tasks_.assign(1, {lights.root(), 1.0, 0, n});
    draw(lights, receivers, bound, 1.0 / double(n));
    return drawn_;
}

void LightSampler::make_cut(const LightHierarchy& lights, const ReceiverBounds& receivers, float bound,
                            std::uint32_t n) {
    // A single light cannot be parted: it stands last.
    const auto less = [](const Group& a, const Group& b) {
        const bool x = a.cluster.single(), y = b.cluster.single();
        return x != y ? x : a.expected < b.expected;
    };
    cut_.clear();
    const auto add = [&](const LightCluster& c) {
        const double expected = expected_sum(lights.node(c), receivers, bound);
        if (!(expected > 0.0)) return;  // nothing can arrive
        cut_.push_back({c, expected});
        std::push_heap(cut_.begin(), cut_.end(), less);
    };
    add(lights.root());
    while (!cut_.empty() && cut_.size() < n && !cut_.front().cluster.single()) {
        std::pop_heap(cut_.begin(), cut_.end(), less);
        const LightCluster group = cut_.back().cluster;
        cut_.pop_back();
        add(lights.left(group)), add(lights.right(group));
    }
}

std::span<const WeightedVpl> LightSampler::by_cut(const LightHierarchy& lights,
                                                  const ReceiverBounds& receivers, float bound,
                                                  std::uint32_t n, Rng& rng) {
    drawn_.clear(), cut_.clear();
    if (lights.empty() || !receivers.any_active) return drawn_;
    make_cut(lights, receivers, bound, n);
    numbers_.clear(), tasks_.clear();
    for (const Group& group : cut_) {
        tasks_.push_back({group.cluster, 1.0, numbers_.size(), numbers_.size() + 1});
        numbers_.push_back(double(rng.next_float()));
    }
    draw(lights, receivers, bound, 1.0);
    return drawn_;
}

}  // namespace mote::lights
