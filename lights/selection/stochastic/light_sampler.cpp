#include "lights/selection/stochastic/light_sampler.h"

#include <algorithm>
#include <cmath>

namespace mote::lights {

using namespace core;

namespace {

/// In [0, 1), in steps of 2^-53: probabilities far below 2^-24 are met.
double next_double(Rng& rng) {
    const std::uint64_t high = rng.next_u32();
    return double((high << 32 | rng.next_u32()) >> 11) * 0x1p-53;
}

/// Importance of each child after the sum of those to its left; not all 0.
struct ChildProbabilities {
    std::array<double, max_children + 1> before;

    ChildProbabilities(const WideLightNode& node, const ReceiverClusters& receivers, float bound)
        : ChildProbabilities(node, importance(LightChildren(node), receivers, bound)) {}
    ChildProbabilities(const WideLightNode& node, const std::array<float, max_children>& importances) {
        if (!add(importances.data())) add(node.energy_fraction);
    }
    double of(int i) const { return (at(i + 1) - at(i)) / before[max_children]; }
    double at(int i) const { return before[std::size_t(i)]; }

  private:
    bool add(const float* values) {
        before[0] = 0.0;
        for (std::size_t i = 0; i < max_children; ++i) before[i + 1] = before[i] + double(values[i]);
        return before[max_children] > 0.0;
    }
};

/// True where the VPLs of each child with a cosine face one way: a cone of 29 degrees to both sides.
bool face_one_way(const WideLightNode& node) {
    constexpr int narrow = 64;
    for (int i = 0; i < node.count; ++i)
        if ((node.has_cosine >> i & 1) != 0 && node.half_sine[i] > narrow) return false;
    return true;
}

/// True where all receivers are farther from a node than three times its diagonal: its VPLs are at one
/// distance.
bool far_from(const WideLightNode& node, const ReceiverClusters& receivers) {
    constexpr float distance2 = 9.0f;
    const Vec3 size = 255.0f * node.step, middle = node.lower + 0.5f * size;
    const float least = distance2 * glm::dot(size, size);
    for (const ReceiverClusters::Cluster& x : receivers.all()) {
        const Vec3 gap = glm::max(glm::max(x.box.lower - middle, middle - x.box.upper), Vec3(0.0f));
        if (glm::dot(gap, gap) < least) return false;
    }
    return true;
}

/// A single VPL cannot be split: it is last.
bool less(const LightSampler::Cluster& a, const LightSampler::Cluster& b) {
    return a.is_light != b.is_light ? a.is_light : a.importance < b.importance;
}

}  // namespace

std::vector<double> probabilities(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                                  std::size_t lights) {
    std::vector<double> p(lights, 0.0);
    std::vector<std::pair<const WideLightNode*, double>> tasks;
    if (!tree.empty()) tasks.emplace_back(&tree.root(), 1.0);
    while (!tasks.empty()) {
        const auto [node, reached] = tasks.back();
        tasks.pop_back();
        const ChildProbabilities probabilities(*node, receivers, bound);
        for (int i = 0; i < node->count; ++i)
            if (node->leaf(i))
                p[node->child[i]] = reached * probabilities.of(i);
            else
                tasks.emplace_back(&tree.node(node->child[i]), reached * probabilities.of(i));
    }
    return p;
}

void LightSampler::begin(const ReceiverClusters& receivers) {
    samples_.clear(), cut_.clear(), values_.clear(), tasks_.clear(), steps_.clear(), origins_.clear();
    const double weight = double(receivers.weight());
    per_light_ = weight > 0.0 ? 1.0 / weight : 0.0;
}

/// Scales the importances of the children of a node by m over the node's; also returns the means. False where
/// nothing is learned.
bool LightSampler::learned(const Task& task, std::array<float, max_children>& light,
                           LearnedImportance::Means& means) const {
    if (!task.known || !learned_->of_children(task.node, task.mean, means)) {
        means.fill(task.mean);
        return false;
    }
    for (std::size_t i = 0; i < max_children; ++i) light[i] *= means[i].over(task.mean);
    return true;
}

std::uint32_t LightSampler::add_step(const Step& step) {
    steps_.push_back(step);
    return std::uint32_t(steps_.size() - 1);
}

void LightSampler::add_light(std::uint32_t light, double weight, std::uint32_t step, double per_weight,
                             const LearnedMean& mean) {
    samples_.push_back({light, float(weight)});
    if (learned_) origins_.push_back({step, float(per_weight), std::sqrt(mean.rays)});
}

void LightSampler::learn(std::size_t i, double light, float rays, float ray_squares) {
    const double estimate = light * per_light_ * double(origins_[i].per_weight);
    double square = 0.0;
    for (std::uint32_t s = origins_[i].step; s != none; s = steps_[s].above) {
        const Step& step = steps_[s];
        if (step.per_importance > 0.0) {
            const double r = std::min(estimate * step.per_importance, 1e9);
            square = r * r;
        }
        learned_->add(step.node, step.child, float(square), rays, ray_squares);
    }
    learned_->add_to_all(float(square), rays, ray_squares);
}

void LightSampler::sample_descendants(const WideLightTree& tree, const ReceiverClusters& receivers,
                                      float bound, double scale, Rng& rng) {
    // One level after the other: nodes are prefetched while others are evaluated.
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
        const Task task = tasks_[t];
        const WideLightNode& node = tree.node(task.node);
        std::array<float, max_children> importances;
        // Where VPLs differ in nothing but energy, or are candidates that are evaluated anyway.
        const bool alike = !task.known && task.levels <= 0 && face_one_way(node) &&
                           (candidates_only_ || far_from(node, receivers));
        if (alike)
            std::copy(node.energy_fraction, node.energy_fraction + max_children, importances.begin());
        else
            importances = importance(LightChildren(node), receivers, bound);
        const auto plain = importances;
        LearnedImportance::Means means;
        const bool known = learned(task, importances, means);
        const ChildProbabilities probabilities(node, importances);
        // Samples are points k + u; those within count times the probability of a child are its own.
        const double u = next_double(rng), per_value = double(task.count) / probabilities.at(max_children);
        auto done = std::uint32_t(0);
        for (int i = 0; i < node.count && done < task.count; ++i) {
            const auto end = std::min(std::uint32_t(probabilities.at(i + 1) * per_value + u), task.count);
            if (end == done) continue;
            const auto k = std::size_t(i);
            const std::uint32_t count = end - done;
            const double p = task.p * probabilities.of(i), sent = task.energy * double(plain[k]);
            std::uint32_t step = task.step;
            if (learned_ && task.levels > 0 && sent > 0.0) step = add_step({task.node, step, i, p / sent});
            if (node.leaf(i)) {
                add_light(node.child[i], double(count) * scale / p, step, 1.0 / (double(count) * scale),
                          means[k]);
            } else {
                tree.prefetch(node.child[i]);
                tasks_.push_back({node.child[i], count, step, task.levels - 1, means[k], known, p,
                                  task.energy * double(node.energy_fraction[i])});
            }
            done = end;
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_tree(const WideLightTree& tree,
                                                   const ReceiverClusters& receivers, float bound,
                                                   std::uint32_t n, Rng& rng) {
    begin(receivers);
    if (tree.empty() || receivers.empty()) return samples_;
    tasks_.push_back(
        {tree.root_index(), n, none, levels_from_root, of_all(), learned_ && !learned_->empty(), 1.0, 1.0});
    sample_descendants(tree, receivers, bound, 1.0 / double(n), rng);
    return samples_;
}

/// Adds a cluster without the children of importance 0 at its ends; none where all are.
void LightSampler::add_cluster(const WideLightTree& tree, Cluster g) {
    const auto& values = values_[g.values].light;
    const auto dark = [&](int i) { return !(values[std::size_t(i)] > 0.0f); };
    while (g.first < g.last && dark(g.first)) ++g.first;
    while (g.first < g.last && dark(g.last - 1)) --g.last;
    if (g.first == g.last) return;
    g.is_light = g.last - g.first == 1 && tree.node(g.node).leaf(g.first);
    g.importance = 0.0;
    for (int i = g.first; i < g.last; ++i) g.importance += double(values[std::size_t(i)]);
    g.importance *= values_[g.values].energy * std::sqrt(double(values_[g.values].above.square()));
    cut_.push_back(g);
    std::push_heap(cut_.begin(), cut_.end(), &less);
}

void LightSampler::add_node(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                            const Task& task) {
    const WideLightNode& node = tree.node(task.node);
    Values& values = values_.emplace_back();
    values.light = importance(LightChildren(node), receivers, bound);
    values.plain = values.light;
    values.known = learned(task, values.light, values.means);
    values.step = task.step, values.energy = task.energy, values.above = task.mean;
    add_cluster(tree, {task.node, std::uint32_t(values_.size() - 1), 0, node.count, false, 0.0});
}

void LightSampler::make_cut(const WideLightTree& tree, const ReceiverClusters& receivers, float bound,
                            std::uint32_t n) {
    add_node(tree, receivers, bound,
             {tree.root_index(), 1, none, 0, of_all(), learned_ && !learned_->empty(), 1.0, 1.0});
    while (!cut_.empty() && !cut_.front().is_light && cut_.size() < n) {
        std::pop_heap(cut_.begin(), cut_.end(), &less);
        const Cluster cluster = cut_.back();
        cut_.pop_back();
        const WideLightNode& node = tree.node(cluster.node);
        const Values& values = values_[cluster.values];
        if (cluster.last - cluster.first == 1) {
            const int i = cluster.first;
            const std::uint32_t step = learned_ ? add_step({cluster.node, values.step, i, 0.0}) : none;
            add_node(tree, receivers, bound,
                     {node.child[i], 1, step, 0, values.means[std::size_t(i)], values.known, 1.0,
                      values.energy * double(node.energy_fraction[i])});
            continue;
        }
        // Halves of importances as equal as can be.
        const double all = cluster.importance / (values.energy * std::sqrt(double(values.above.square())));
        int middle = cluster.first + 1;
        double left = 0.0, most = -1.0;
        for (int i = cluster.first; i + 1 < cluster.last; ++i) {
            left += double(values.light[std::size_t(i)]);
            if (const double lesser = std::min(left, all - left); lesser > most)
                most = lesser, middle = i + 1;
        }
        Cluster half = cluster;
        half.last = middle, add_cluster(tree, half);
        half.first = middle, half.last = cluster.last, add_cluster(tree, half);
    }
}

/// Samples children of the cluster: adds VPLs, or tasks.
void LightSampler::sample_cluster(const WideLightTree& tree, const Cluster& cluster, std::uint32_t count,
                                  Rng& rng) {
    const WideLightNode& node = tree.node(cluster.node);
    const Values& values = values_[cluster.values];
    double sum = 0.0, reached = 0.0;
    for (int i = cluster.first; i < cluster.last; ++i) sum += double(values.light[std::size_t(i)]);
    // As in sample().
    const double u = next_double(rng), per_value = double(count) / sum;
    std::uint32_t done = 0;
    for (int i = cluster.first; i < cluster.last && done < count; ++i) {
        const auto k = std::size_t(i);
        reached += double(values.light[k]);
        const auto end =
            i + 1 < cluster.last ? std::min(std::uint32_t(reached * per_value + u), count) : count;
        if (end == done) continue;
        const std::uint32_t own = end - done;
        done = end;
        const double p = double(values.light[k]) / sum;
        const std::uint32_t step =
            learned_ ? add_step({cluster.node, values.step, i, p / (values.energy * double(values.plain[k]))})
                     : none;
        if (node.leaf(i)) {
            add_light(node.child[i], double(own) / (double(count) * p), step, double(count) / double(own),
                      values.means[k]);
        } else {
            tree.prefetch(node.child[i]);
            tasks_.push_back({node.child[i], own, step, count > 1 ? 0 : levels_below_clusters,
                              values.means[k], values.known, p,
                              values.energy * double(node.energy_fraction[i])});
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_cut(const WideLightTree& tree,
                                                  const ReceiverClusters& receivers, float bound,
                                                  std::uint32_t n, Rng& rng) {
    return from_clusters(tree, receivers, bound, n, 1, rng);
}

std::span<const WeightedVpl> LightSampler::from_clusters(const WideLightTree& tree,
                                                         const ReceiverClusters& receivers, float bound,
                                                         std::uint32_t n, std::uint32_t each, Rng& rng) {
    begin(receivers);
    if (tree.empty() || receivers.empty()) return samples_;
    make_cut(tree, receivers, bound, n);
    for (const Cluster& cluster : cut_) sample_cluster(tree, cluster, each, rng);
    candidates_only_ = each > 1;
    sample_descendants(tree, receivers, bound, 1.0 / double(each), rng);
    candidates_only_ = false;
    return samples_;
}

}  // namespace mote::lights
