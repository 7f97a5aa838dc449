#include "lights/selection/lightcuts/gather_points.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int point_lanes = ReceiverLanes::width;

void copy_lane(ReceiverTile& to, const ReceiverTile& from, int i, float scale, const Rng& rng) {
    to.x[i] = from.x[i], to.y[i] = from.y[i], to.z[i] = from.z[i];
    to.shading_x[i] = from.shading_x[i], to.shading_y[i] = from.shading_y[i];
    to.shading_z[i] = from.shading_z[i], to.geometric_x[i] = from.geometric_x[i];
    to.geometric_y[i] = from.geometric_y[i], to.geometric_z[i] = from.geometric_z[i];
    to.in_medium[i] = from.in_medium[i];
    to.weight_r[i] = scale * from.weight_r[i], to.weight_g[i] = scale * from.weight_g[i];
    to.weight_b[i] = scale * from.weight_b[i];
    to.max_vpl_depth[i] = from.max_vpl_depth[i];
    to.directional[i] = from.directional[i];
    to.any_directional |= from.directional[i] != nullptr, to.any_active = true;
    to.state[i] = from.state[i], to.rng[i] = rng;
}

/// Weight of a lane's point among representatives; 0 for an idle lane.
float importance(const ReceiverTile& tile, int i) {
    if (tile.max_vpl_depth[i] == 0) return 0.0f;
    return (tile.weight_r[i] + tile.weight_g[i] + tile.weight_b[i]) * (1.0f / 3.0f);
}

void describe(GatherNode& node) {
    node.lobes = ReceiverLobes(node.representative);
    node.sets = ReceiverSets(node.representative);
}

}  // namespace

void GatherPoints::add(const ReceiverTile& tile, ReceiverKind kind) {
    if (!tile.any_active) return;
    leaves_[std::size_t(kind)].push_back(std::uint32_t(nodes_.size()));
    ReceiverTile own = tile;
    for (const ScatteringVertex*& vertex : own.directional)
        if (vertex) vertex = &vertices_.emplace_back(*vertex);
    nodes_.push_back({own, ReceiverBounds(own)});
    describe(nodes_.back());
}

void GatherPoints::build(Rng& rng) {
    for (std::size_t kind = 0; kind < 2; ++kind)
        roots_[kind] = leaves_[kind].empty() ? none : build(leaves_[kind], 0, leaves_[kind].size(), rng);
}

std::uint32_t GatherPoints::build(const std::vector<std::uint32_t>& leaves, std::size_t first,
                                  std::size_t last, Rng& rng) {
    if (last - first == 1) return leaves[first];
    const std::size_t middle = (first + last) / 2;
    const std::uint32_t left = build(leaves, first, middle, rng);
    return join(left, build(leaves, middle, last, rng), rng);
}

std::uint32_t GatherPoints::join(std::uint32_t left, std::uint32_t right, Rng& rng) {
    const GatherNode &a = nodes_[left], &b = nodes_[right];
    GatherNode node{{}, ReceiverBounds(a.bounds, b.bounds), left, right};
    ReceiverTile& own = node.representative;
    own.clear();
    for (int i = 0; i < point_lanes; ++i) {
        const float wa = importance(a.representative, i), wb = importance(b.representative, i);
        const float u = rng.next_float();
        if (!(wa + wb > 0.0f)) continue;
        const bool chooses_a = u * (wa + wb) < wa;
        copy_lane(own, (chooses_a ? a : b).representative, i, (wa + wb) / (chooses_a ? wa : wb),
                  Rng(rng.next_u32()));
    }
    node.diagonal2 = node.bounds.diagonal2();
    describe(node);
    nodes_.push_back(std::move(node));
    return std::uint32_t(nodes_.size() - 1);
}

}  // namespace mote::lights
