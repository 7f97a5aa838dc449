#include "lights/guiding/guiding_field.h"

#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <stdexcept>

namespace mote::lights {

using core::Vec3, core::Vec3d;

namespace {

/// Mean and variance of positions, which may lie far from the origin.
struct Spread {
    Vec3d mean{0.0}, variance{0.0};
    explicit Spread(std::span<const GuidingSample> samples) {
        const Vec3d origin(samples.front().position);
        Vec3d squares(0.0);
        for (const GuidingSample& s : samples) {
            const Vec3d d = Vec3d(s.position) - origin;
            mean += d, squares += d * d;
        }
        mean /= double(samples.size());
        variance = squares / double(samples.size()) - mean * mean;
        mean += origin;
    }
};

}  // namespace

GuidingField::GuidingField(const Settings& settings, const core::MemoryBudget& memory)
    : leaf_samples_(settings.leaf_samples),
      max_leaves_(
          std::max(std::size_t(1), std::size_t(settings.bytes / (sizeof(MixtureFit) + 2 * sizeof(Node))))),
      nodes_(1) {
    memory.require(settings.bytes, "the field of guided paths");
    leaves_.reserve(max_leaves_), nodes_.reserve(2 * max_leaves_);
}

VmfMixture GuidingField::at(const Vec3& position) const {
    return leaves_.empty() ? VmfMixture{} : leaves_[leaf_of(position)].at(position);
}

std::size_t GuidingField::leaf_of(const Vec3& position) const {
    const float coordinates[3] = {position.x, position.y, position.z};  // Vec3 finds an index by branches
    const Node* node = nodes_.data();
    while (node->axis >= 0) node = &nodes_[node->next + (coordinates[node->axis] < node->plane ? 0u : 1u)];
    return node->next;
}

void GuidingField::add(std::vector<GuidingSample>& samples) {
    for (const GuidingSample& s : samples)
        if (!(s.weight >= 0.0f) || !std::isfinite(s.weight) || !(s.inverse_distance >= 0.0f) ||
            !std::isfinite(s.inverse_distance))
            throw std::invalid_argument("a sample of the guiding field has a weight that is no radiance");
    if (samples.empty()) return;
    if (leaves_.empty()) leaves_.emplace_back(Vec3(Spread(samples).mean));
    std::vector<Share> shares;
    distribute(0, samples, 0, samples.size(), shares);
    tbb::parallel_for_each(shares, [&](const Share& s) {
        leaves_[s.leaf].add(std::span(samples).subspan(s.begin, s.end - s.begin));
    });
}

void GuidingField::distribute(std::uint32_t node, std::vector<GuidingSample>& samples, std::size_t begin,
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
    const auto middle = std::size_t(
        std::stable_partition(first, last,
                              [&](const GuidingSample& s) { return s.position[here.axis] < here.plane; }) -
        samples.begin());
    distribute(here.next, samples, begin, middle, shares);
    distribute(here.next + 1, samples, middle, end, shares);
}

/// Leaves the node as it is where the samples do not lie apart.
void GuidingField::split(std::uint32_t node, std::span<GuidingSample> samples) {
    const Spread spread(samples);
    int axis = spread.variance.y > spread.variance.x ? 1 : 0;
    if (spread.variance.z > spread.variance[axis]) axis = 2;
    const auto plane = float(spread.mean[axis]);
    const auto middle = std::stable_partition(
        samples.begin(), samples.end(), [&](const GuidingSample& s) { return s.position[axis] < plane; });
    const std::span below(samples.begin(), middle), above(middle, samples.end());
    if (below.empty() || above.empty()) return;

    const std::uint32_t leaf = nodes_[node].next, children = std::uint32_t(nodes_.size());
    MixtureFit half = leaves_[leaf];
    half.scale(0.5);
    leaves_[leaf] = half.moved_to(Vec3(Spread(below).mean));
    leaves_.push_back(half.moved_to(Vec3(Spread(above).mean)));
    nodes_[node] = {plane, axis, children};
    nodes_.push_back({0.0f, -1, leaf});
    nodes_.push_back({0.0f, -1, std::uint32_t(leaves_.size() - 1)});
}

void GuidingField::scale(double factor) {
    for (MixtureFit& leaf : leaves_) leaf.scale(factor);
}

}  // namespace mote::lights
