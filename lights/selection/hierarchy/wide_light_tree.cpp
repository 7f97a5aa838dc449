#include "lights/selection/hierarchy/wide_light_tree.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cstring>

#include "core/math/vectorize.h"
#include "core/objects/error.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr std::uint32_t side_by_side_from = 4096;  // lights
/// Clusters of fewer lights are split into multiples of eight, so that the last nodes are full.
constexpr std::uint32_t whole_below = 512;

std::uint8_t to_byte(float x) { return std::uint8_t(std::clamp(x, 0.0f, 255.0f)); }

Vec3 decode_axis(std::uint8_t u, std::uint8_t v) {
    return octahedral_unproject({(float(u) - 127.0f) / 127.0f, (float(v) - 127.0f) / 127.0f});
}

/// A cone that holds another, from few bits.
void set_cone(WideLightNode& node, int i, const LightNode& child) {
    const Vec3 axis = child.axis();
    const Vec2 p = octahedral_project(axis);
    node.axis_u[i] = to_byte(std::round(127.0f * p.x) + 127.0f);
    node.axis_v[i] = to_byte(std::round(127.0f * p.y) + 127.0f);
    const Vec3 coded = decode_axis(node.axis_u[i], node.axis_v[i]);
    const float moved = std::atan2(glm::length(glm::cross(axis, coded)), glm::dot(axis, coded));
    const float angle = std::min(child.cone().angle + moved + (moved > 1e-4f ? 1e-5f : 0.0f), pi);
    node.half_sine[i] = to_byte(std::ceil(255.0f * std::sin(0.5f * angle) - 2e-3f));
}

void set_child(WideLightNode& node, int i, const LightNode& child, float cluster_weight) {
    for (int k = 0; k < 3; ++k) {
        const float per_step = node.step[k] > 0.0f ? 1.0f / node.step[k] : 0.0f;
        float low = std::floor((child.lower[k] - node.lower[k]) * per_step);
        float high = std::ceil((child.upper[k] - node.lower[k]) * per_step);
        while (low > 0.0f && node.lower[k] + low * node.step[k] > child.lower[k]) low -= 1.0f;
        while (high < 255.0f && node.lower[k] + high * node.step[k] < child.upper[k]) high += 1.0f;
        node.low[k][i] = to_byte(low), node.high[k][i] = to_byte(high);
    }
    node.energy_fraction[i] = std::max(child.weight() / cluster_weight, 1e-30f);
    set_cone(node, i, child);
    node.min_depth[i] = std::uint8_t(std::min<int>(child.min_depth, 255));
    if (child.kind == LightKind::surface || child.kind == LightKind::glossy)
        node.has_cosine = std::uint8_t(node.has_cosine | 1 << i);
    if (child.kind != LightKind::volume || child.g_high == 0) return;
    node.any_lobe = 1;
    node.g_low[i] = to_byte(std::floor(float(child.g_low) / 257.0f));
    node.g_high[i] = std::uint8_t(std::max(int(to_byte(std::ceil(float(child.g_high) / 257.0f))), 1));
}

/// VPLs [first, first + count) of a child.
struct LightRange {
    std::uint32_t first, count;
};

}  // namespace

class WideLightTree::Builder {
  public:
    Builder(const LightLeaves& leaves, LightPartition& partition, std::vector<WideLightNode>& nodes)
        : leaves_(leaves), partition_(partition), nodes_(nodes) {}

    std::uint32_t build() {
        std::uint32_t root = 0;
        build({0, partition_.size()}, root);
        return root;
    }

  private:
    /// Large ranges are split side by side, each small one by one thread into nodes of its own.
    LightNode build(const LightRange& range, std::uint32_t& index) {
        if (range.count < side_by_side_from) {
            std::vector<WideLightNode> own;
            const LightNode all = build_small(range, own);
            const std::lock_guard lock(mutex_);
            const auto base = std::uint32_t(nodes_.size());
            for (WideLightNode& node : own)
                for (int i = 0; i < node.count; ++i)
                    if (!node.leaf(i)) node.child[i] += base;
            index = base;
            nodes_.insert(nodes_.end(), own.begin(), own.end());
            return all;
        }
        std::array<LightRange, max_children> ranges;
        const int count = split(range, ranges);
        std::array<LightNode, max_children> built;
        std::array<std::uint32_t, max_children> children{};
        tbb::parallel_for(0, count, [&](int i) {
            const auto k = std::size_t(i);
            built[k] = ranges[k].count == 1 ? leaf(ranges[k], children[k]) : build(ranges[k], children[k]);
        });
        LightNode all;
        const WideLightNode node = join(ranges, built, children, count, all);
        const std::lock_guard lock(mutex_);
        index = std::uint32_t(nodes_.size());
        nodes_.push_back(node);
        return all;
    }

    /// The node of the range comes first.
    LightNode build_small(const LightRange& range, std::vector<WideLightNode>& nodes) {
        const std::size_t own = nodes.size();
        nodes.emplace_back();
        std::array<LightRange, max_children> ranges;
        const int count = split(range, ranges);
        std::array<LightNode, max_children> built;
        std::array<std::uint32_t, max_children> children{};
        for (std::size_t i = 0; i < std::size_t(count); ++i) {
            if (ranges[i].count == 1) {
                built[i] = leaf(ranges[i], children[i]);
            } else {
                children[i] = std::uint32_t(nodes.size());
                built[i] = build_small(ranges[i], nodes);
            }
        }
        LightNode all;
        nodes[own] = join(ranges, built, children, count, all);
        return all;
    }

    LightNode leaf(const LightRange& range, std::uint32_t& light) const {
        light = partition_.item(range.first).light;
        return leaves_.leaf(light);
    }

    /// The largest ranges first, until there are eight or all are small enough for a node of their own. What
    /// was split last are neighbours.
    int split(const LightRange& range, std::array<LightRange, max_children>& ranges) {
        ranges[0] = range;
        int count = 1;
        if (range.count <= max_children) {
            for (; count < int(range.count); ++count)
                ranges[std::size_t(count)] = {range.first + std::uint32_t(count), 1};
            ranges[0].count = 1;
            return count;
        }
        while (count < max_children) {
            LightRange& most =
                *std::max_element(ranges.begin(), ranges.begin() + count,
                                  [](const LightRange& a, const LightRange& b) { return a.count < b.count; });
            if (most.count <= max_children) break;
            const std::uint32_t n =
                partition_.split(most.first, most.count, most.count < whole_below ? max_children : 1);
            const LightRange right{most.first + n, most.count - n};
            most.count = n;
            std::move_backward(&most + 1, ranges.data() + count, ranges.data() + count + 1);
            (&most)[1] = right, ++count;
        }
        return count;
    }

    static WideLightNode join(const std::array<LightRange, max_children>& ranges,
                              const std::array<LightNode, max_children>& nodes,
                              const std::array<std::uint32_t, max_children>& children, int count,
                              LightNode& all) {
        all = nodes[0];
        for (int i = 1; i < count; ++i) all = united(all, nodes[std::size_t(i)]);
        WideLightNode node{};
        node.count = std::uint8_t(count);
        node.lower = all.lower, node.step = (all.upper - all.lower) * (1.00001f / 255.0f);
        for (int i = 0; i < count; ++i) {
            node.child[i] = children[std::size_t(i)];
            if (ranges[std::size_t(i)].count == 1) node.is_light = std::uint8_t(node.is_light | 1 << i);
            set_child(node, i, nodes[std::size_t(i)], all.weight());
        }
        return node;
    }

    const LightLeaves& leaves_;
    LightPartition& partition_;
    std::vector<WideLightNode>& nodes_;
    std::mutex mutex_;
};

WideLightTree::WideLightTree(const LightLeaves& leaves, std::size_t max_bytes) {
    const std::size_t needed = leaves.size() * (bytes_a_light + building_bytes_a_light);
    if (leaves.size() > (std::size_t(1) << 31) || needed > max_bytes)
        throw InputError(
            fmt::format("a tree over {} lights takes {:.3g} MB while it is built, and may take {:.3g} MB",
                        leaves.size(), double(needed) * 1e-6, double(max_bytes) * 1e-6));
    LightPartition partition(leaves);
    size_ = partition.size();
    if (size_ == 0) return;
    nodes_.reserve(size_ * bytes_a_light / sizeof(WideLightNode) +
                   max_children);  // untouched pages cost nothing
    root_ = Builder(leaves, partition, nodes_).build();
}

namespace {

/// A vector of bytes as floats. Loops of one kind of conversion are what compilers make vectors of.
inline void to_floats(const std::uint8_t* bytes, float* floats) {
    std::uint8_t in[max_children];
    std::memcpy(in, bytes, max_children);
    for (int i = 0; i < max_children; ++i) floats[i] = float(in[i]);
}

}  // namespace

LightChildren::LightChildren(const WideLightNode& n) : any_lobe(n.any_lobe != 0) {
    alignas(32) float low[3][max_children], high[3][max_children], u[max_children], v[max_children],
        h[max_children];
    for (int k = 0; k < 3; ++k) to_floats(n.low[k], low[k]), to_floats(n.high[k], high[k]);
    to_floats(n.axis_u, u), to_floats(n.axis_v, v), to_floats(n.half_sine, h);
    to_floats(n.min_depth, min_depth);
    const Vec3 lower = n.lower, step = n.step;
    const std::int32_t cosines = n.has_cosine;
    for (int i = 0; i < max_children; ++i) has_cosine[i] = float(cosines >> i & 1);
    for (int i = 0; i < max_children; ++i) energy_fraction[i] = n.energy_fraction[i];
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < max_children; ++i) {
        lower_x[i] = lower.x + low[0][i] * step.x, upper_x[i] = lower.x + high[0][i] * step.x;
        lower_y[i] = lower.y + low[1][i] * step.y, upper_y[i] = lower.y + high[1][i] * step.y;
        lower_z[i] = lower.z + low[2][i] * step.z, upper_z[i] = lower.z + high[2][i] * step.z;
        // core::octahedral_unproject()
        const float a = (u[i] - 127.0f) * (1.0f / 127.0f), b = (v[i] - 127.0f) * (1.0f / 127.0f);
        const float z = 1.0f - std::fabs(a) - std::fabs(b), below = max_of(-z, 0.0f);
        const float x = a - std::copysign(below, a), y = b - std::copysign(below, b);
        const float scale = 1.0f / std::sqrt(x * x + y * y + z * z);
        axis_x[i] = x * scale, axis_y[i] = y * scale, axis_z[i] = z * scale;
        const float half = h[i] * (1.0f / 255.0f), c = 1.0f - 2.0f * half * half;
        cos_angle[i] = c, sin_angle[i] = std::sqrt(max_of(1.0f - c * c, 0.0f));
    }
    if (!any_lobe) return;
    to_floats(n.g_low, g_low), to_floats(n.g_high, g_high);
    for (int i = 0; i < max_children; ++i) g_low[i] *= 1.0f / 255.0f, g_high[i] *= 1.0f / 255.0f;
}

}  // namespace mote::lights
