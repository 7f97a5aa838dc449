#include "lights/selection/light_sampler.h"

#include <algorithm>
#include <cmath>

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

    Shares(const LightTreeNode& node, const ReceiverGroups& receivers, float bound)
        : Shares(node, expected_light(LightParts(node), receivers, bound)) {}
    Shares(const LightTreeNode& node, const std::array<float, most_parts>& expected) {
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

/// Do lights with a cosine, of each part, face one way? A cone of 29 degrees to both sides.
bool face_one_way(const LightTreeNode& node) {
    constexpr int narrow = 64;
    for (int i = 0; i < node.count; ++i)
        if ((node.has_cosine >> i & 1) != 0 && node.half_sine[i] > narrow) return false;
    return true;
}

/// Do all receivers stand so far from a group, three times its diagonal, that its lights are at one distance?
bool far_from(const LightTreeNode& node, const ReceiverGroups& receivers) {
    constexpr float distance2 = 9.0f;
    const Vec3 size = 255.0f * node.step, middle = node.lower + 0.5f * size;
    const float least = distance2 * glm::dot(size, size);
    for (const ReceiverGroups::Group& x : receivers.all()) {
        const Vec3 gap = glm::max(glm::max(x.box.lower - middle, middle - x.box.upper), Vec3(0.0f));
        if (glm::dot(gap, gap) < least) return false;
    }
    return true;
}

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

void LightSampler::begin(const ReceiverGroups& receivers) {
    drawn_.clear(), cut_.clear(), values_.clear(), tasks_.clear(), steps_.clear(), origins_.clear();
    const double weight = double(receivers.weight());
    per_light_ = weight > 0.0 ? 1.0 / weight : 0.0;
}

/// Of the parts of a node, and m into `light`, what they are expected to send. Returns whether more is known.
bool LightSampler::learned(const Task& task, std::array<float, most_parts>& light,
                           LearnedShares::Means& means) const {
    if (!task.known || !learned_->of_parts(task.node, task.mean, means)) {
        means.fill(task.mean);
        return false;
    }
    for (std::size_t i = 0; i < most_parts; ++i) light[i] *= means[i].over(task.mean);
    return true;
}

std::uint32_t LightSampler::add_step(const Step& step) {
    steps_.push_back(step);
    return std::uint32_t(steps_.size() - 1);
}

void LightSampler::add_light(std::uint32_t light, double weight, std::uint32_t step, double per_weight,
                             const LearnedMean& mean) {
    drawn_.push_back({light, float(weight)});
    if (learned_) origins_.push_back({step, float(per_weight), std::sqrt(mean.rays)});
}

void LightSampler::learn(std::size_t i, double light, float rays, float ray_squares) {
    const double estimate = light * per_light_ * double(origins_[i].per_weight);
    double square = 0.0;
    for (std::uint32_t s = origins_[i].step; s != none; s = steps_[s].above) {
        const Step& step = steps_[s];
        if (step.per_expected > 0.0) {
            const double r = std::min(estimate * step.per_expected, 1e9);
            square = r * r;
        }
        learned_->add(step.node, step.part, float(square), rays, ray_squares);
    }
    learned_->add_to_all(float(square), rays, ray_squares);
}

void LightSampler::draw(const LightTree& tree, const ReceiverGroups& receivers, float bound, double scale,
                        Rng& rng) {
    // One level after the other, so that nodes arrive from memory while others are looked at.
    for (std::size_t t = 0; t < tasks_.size(); ++t) {
        const Task task = tasks_[t];
        const LightTreeNode& node = tree.node(task.node);
        std::array<float, most_parts> expected;
        // Where lights differ in nothing but energy, or somebody looks at each of them anyway.
        const bool alike = !task.known && task.levels <= 0 && face_one_way(node) &&
                           (looked_at_ || far_from(node, receivers));
        if (alike)
            std::copy(node.share, node.share + most_parts, expected.begin());
        else
            expected = expected_light(LightParts(node), receivers, bound);
        const auto plain = expected;
        LearnedShares::Means means;
        const bool known = learned(task, expected, means);
        const Shares shares(node, expected);
        // Draws are points k + u; those within count times the share of a part are its own.
        const double u = next_double(rng), per_value = double(task.count) / shares.at(most_parts);
        auto done = std::uint32_t(0);
        for (int i = 0; i < node.count && done < task.count; ++i) {
            const auto end = std::min(std::uint32_t(shares.at(i + 1) * per_value + u), task.count);
            if (end == done) continue;
            const auto k = std::size_t(i);
            const std::uint32_t count = end - done;
            const double p = task.p * shares.of(i), sent = task.energy * double(plain[k]);
            std::uint32_t step = task.step;
            if (learned_ && task.levels > 0 && sent > 0.0) step = add_step({task.node, step, i, p / sent});
            if (node.leaf(i)) {
                add_light(node.child[i], double(count) * scale / p, step, 1.0 / (double(count) * scale),
                          means[k]);
            } else {
                tree.prefetch(node.child[i]);
                tasks_.push_back({node.child[i], count, step, task.levels - 1, means[k], known, p,
                                  task.energy * double(node.share[i])});
            }
            done = end;
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_tree(const LightTree& tree, const ReceiverGroups& receivers,
                                                   float bound, std::uint32_t n, Rng& rng) {
    begin(receivers);
    if (tree.empty() || receivers.empty()) return drawn_;
    tasks_.push_back(
        {tree.root_index(), n, none, levels_of_draws, of_all(), learned_ && !learned_->empty(), 1.0, 1.0});
    draw(tree, receivers, bound, 1.0 / double(n), rng);
    return drawn_;
}

/// Adds a group without the parts at its ends that send nothing, and nothing where none sends any.
void LightSampler::add_group(const LightTree& tree, Group g) {
    const auto& values = values_[g.values].light;
    const auto dark = [&](int i) { return !(values[std::size_t(i)] > 0.0f); };
    while (g.first < g.last && dark(g.first)) ++g.first;
    while (g.first < g.last && dark(g.last - 1)) --g.last;
    if (g.first == g.last) return;
    g.is_light = g.last - g.first == 1 && tree.node(g.node).leaf(g.first);
    g.expected = 0.0;
    for (int i = g.first; i < g.last; ++i) g.expected += double(values[std::size_t(i)]);
    g.expected *= values_[g.values].energy * std::sqrt(double(values_[g.values].above.square()));
    cut_.push_back(g);
    std::push_heap(cut_.begin(), cut_.end(), &less);
}

void LightSampler::add_node(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                            const Task& task) {
    const LightTreeNode& node = tree.node(task.node);
    Values& values = values_.emplace_back();
    values.light = expected_light(LightParts(node), receivers, bound);
    values.plain = values.light;
    values.known = learned(task, values.light, values.means);
    values.step = task.step, values.energy = task.energy, values.above = task.mean;
    add_group(tree, {task.node, std::uint32_t(values_.size() - 1), 0, node.count, false, 0.0});
}

void LightSampler::make_cut(const LightTree& tree, const ReceiverGroups& receivers, float bound,
                            std::uint32_t n) {
    add_node(tree, receivers, bound,
             {tree.root_index(), 1, none, 0, of_all(), learned_ && !learned_->empty(), 1.0, 1.0});
    while (!cut_.empty() && !cut_.front().is_light && cut_.size() < n) {
        std::pop_heap(cut_.begin(), cut_.end(), &less);
        const Group group = cut_.back();
        cut_.pop_back();
        const LightTreeNode& node = tree.node(group.node);
        const Values& values = values_[group.values];
        if (group.last - group.first == 1) {
            const int i = group.first;
            const std::uint32_t step = learned_ ? add_step({group.node, values.step, i, 0.0}) : none;
            add_node(tree, receivers, bound,
                     {node.child[i], 1, step, 0, values.means[std::size_t(i)], values.known, 1.0,
                      values.energy * double(node.share[i])});
            continue;
        }
        // Halves as like as can be.
        const double all = group.expected / (values.energy * std::sqrt(double(values.above.square())));
        int middle = group.first + 1;
        double left = 0.0, most = -1.0;
        for (int i = group.first; i + 1 < group.last; ++i) {
            left += double(values.light[std::size_t(i)]);
            if (const double lesser = std::min(left, all - left); lesser > most)
                most = lesser, middle = i + 1;
        }
        Group half = group;
        half.last = middle, add_group(tree, half);
        half.first = middle, half.last = group.last, add_group(tree, half);
    }
}

/// Adds lights of the group, or tasks for them.
void LightSampler::draw_from(const LightTree& tree, const Group& group, std::uint32_t count, Rng& rng) {
    const LightTreeNode& node = tree.node(group.node);
    const Values& values = values_[group.values];
    double sum = 0.0, reached = 0.0;
    for (int i = group.first; i < group.last; ++i) sum += double(values.light[std::size_t(i)]);
    // As in draw().
    const double u = next_double(rng), per_value = double(count) / sum;
    std::uint32_t done = 0;
    for (int i = group.first; i < group.last && done < count; ++i) {
        const auto k = std::size_t(i);
        reached += double(values.light[k]);
        const auto end = i + 1 < group.last ? std::min(std::uint32_t(reached * per_value + u), count) : count;
        if (end == done) continue;
        const std::uint32_t own = end - done;
        done = end;
        const double p = double(values.light[k]) / sum;
        const std::uint32_t step =
            learned_ ? add_step({group.node, values.step, i, p / (values.energy * double(values.plain[k]))})
                     : none;
        if (node.leaf(i)) {
            add_light(node.child[i], double(own) / (double(count) * p), step, double(count) / double(own),
                      values.means[k]);
        } else {
            tree.prefetch(node.child[i]);
            tasks_.push_back({node.child[i], own, step, count > 1 ? 0 : levels_below_groups, values.means[k],
                              values.known, p, values.energy * double(node.share[i])});
        }
    }
}

std::span<const WeightedVpl> LightSampler::by_cut(const LightTree& tree, const ReceiverGroups& receivers,
                                                  float bound, std::uint32_t n, Rng& rng) {
    return from_groups(tree, receivers, bound, n, 1, rng);
}

std::span<const WeightedVpl> LightSampler::from_groups(const LightTree& tree, const ReceiverGroups& receivers,
                                                       float bound, std::uint32_t n, std::uint32_t each,
                                                       Rng& rng) {
    begin(receivers);
    if (tree.empty() || receivers.empty()) return drawn_;
    make_cut(tree, receivers, bound, n);
    for (const Group& group : cut_) draw_from(tree, group, each, rng);
    looked_at_ = each > 1;
    draw(tree, receivers, bound, 1.0 / double(each), rng);
    looked_at_ = false;
    return drawn_;
}

}  // namespace mote::lights
