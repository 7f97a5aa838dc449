#include "lights/selection/group_candidates.h"

#include <algorithm>

#include "core/math/vectorize.h"
#include "lights/selection/cluster_bounds.h"

namespace mote::lights {

void GroupCandidates::draw(const LightHierarchy& lights, const PowerCandidates& power,
                           const ReceiverBounds& receivers, float bound, std::uint32_t n, core::Rng& rng,
                           std::vector<WeightedVpl>& drawn) {
    if (lights.empty() || !receivers.any_active) return;
    // A single light cannot be parted: it stands last.
    const auto less = [](const Group& a, const Group& b) {
        const bool x = a.cluster.single(), y = b.cluster.single();
        return x != y ? x : a.expected < b.expected;
    };
    cut_.clear();
    const auto add = [&](const LightCluster& c) {
        LaneValues sent = expected_light(lights.node(c), receivers, bound);
        for (float& v : sent.value) v = core::min_of(v, 1e36f);  // a receiver may stand on a light
        if (!(sent.sum() > 0.0f)) return;                        // nothing can arrive
        lights.prefetch(c);
        cut_.push_back({c, sent.sum()});
        std::push_heap(cut_.begin(), cut_.end(), less);
    };
    add(lights.root());
    const std::size_t groups = std::max(n / lights_a_group, 1u);
    while (!cut_.empty() && cut_.size() < groups && !cut_.front().cluster.single()) {
        std::pop_heap(cut_.begin(), cut_.end(), less);
        const LightCluster group = cut_.back().cluster;
        cut_.pop_back();
        add(lights.left(group)), add(lights.right(group));
    }
    for (const Group& group : cut_) power.draw(group.cluster, lights_a_group, rng, drawn);
}

}  // namespace mote::lights
