// The shadow rays of a lightcut's pairs.
#include <algorithm>
#include <limits>

#include "lights/selection/lightcuts/lightcut.h"

namespace mote::lights {

using namespace core;

/// Chooses the rays of a pair of the batch: one for each set, of a lane sampled in proportion to its light,
/// so that the light of a set is unbiased.
void Lightcut::choose_rays(const GatherNode& node, std::size_t in_batch, const LaneLight& light,
                           const ShadowPacket& packet) {
    float near2 = std::numeric_limits<float>::max();
    for (int i = 0; i < width; ++i)
        if (packet.t_max[i] > 0.0f)
            near2 = std::min(
                near2, sqr(packet.direction_x[i]) + sqr(packet.direction_y[i]) + sqr(packet.direction_z[i]));
    const float angle = settings_.threshold > 0.0f ? settings_.shared_angle : 0.0f;
    const auto& set_of = node.sets.within(angle * std::sqrt(near2));
    std::array<float, width> sum{};
    std::array<std::uint16_t, width> ray_of_set;
    ray_of_set.fill(no_ray);
    for (int i = 0; i < width; ++i) {
        std::uint16_t& own = ray_of_[in_batch][std::size_t(i)];
        own = no_ray;
        if (!(packet.t_max[i] > 0.0f)) continue;
        const std::size_t set = set_of[std::size_t(i)];
        const float weight = light.r[i] + light.g[i] + light.b[i];
        sum[set] += weight;
        std::uint16_t& ray = ray_of_set[set];
        if (ray == no_ray) {
            ray = std::uint16_t(rays_.size());
            rays_.push_back({std::uint8_t(in_batch), std::uint8_t(i)});
        } else if (rng_.next_float() * sum[set] < weight) {
            rays_[ray].lane = std::uint8_t(i);
        }
        own = ray;
    }
}

/// Traces rays_, sixteen a packet, whatever pair they belong to.
void Lightcut::trace(const GatherContext& context) {
    const std::size_t count = (rays_.size() + ShadowPacket::width - 1) / ShadowPacket::width;
    while (packed_.size() < count) packed_.emplace_back().clear();
    for (std::size_t r = 0; r < count * ShadowPacket::width; ++r) {
        ShadowPacket& to = packed_[r / ShadowPacket::width];
        const std::size_t at = r % ShadowPacket::width;
        to.t_min[at] = 0.0f, to.t_max[at] = -1.0f;
        if (r >= rays_.size()) continue;
        const ShadowPacket& from = context.scratch.packets[rays_[r].in_batch];
        const std::size_t i = rays_[r].lane;
        to.set(at, from.origin(i), from.direction(i), from.t_max[i]);
    }
    context.rays.occlusion += rays_.size();
    context.scene.find_occluded(std::span(packed_).first(count));
}

/// Estimates the transmittance of rays that no surface occludes.
void Lightcut::attenuate(const GatherContext& context, GatherPoints& points) {
    const bool attenuates = context.scene.attenuates();
    for (std::size_t r = 0; r < rays_.size(); ++r) {
        const ShadowPacket& packet = packed_[r / ShadowPacket::width];
        const int at = int(r % ShadowPacket::width);
        if (packet.occluded(at)) continue;
        rays_[r].transmittance = Rgb(1.0f);
        if (!attenuates) continue;
        const Vec3 from = packet.origin(at);
        const Vec3 to = from + packet.direction(at);
        ReceiverTile& tile = points.node(pairs_[batch_[rays_[r].in_batch]].points).representative;
        const std::size_t i = rays_[r].lane;
        const ScatteringVertex* v = tile.directional[i];
        const MediumState state = v ? v->state_towards(tile.state[i], to - from) : tile.state[i];
        rays_[r].transmittance = context.scene.transmittance(from, to, state, tile.rng[i], context.tracking);
    }
}

/// Traces the rays of batch_, whose light is in the scratch memory, and writes its estimates.
void Lightcut::resolve(const GatherContext& context, GatherPoints& points) {
    context.cancelled.check();
    rays_.clear();
    for (std::size_t k = 0; k < in_batch_; ++k) {
        const Pair& pair = pairs_[batch_[k]];
        choose_rays(points.node(pair.points), k, context.scratch.light[k], context.scratch.packets[k]);
    }
    trace(context);
    attenuate(context, points);
    for (std::size_t k = 0; k < in_batch_; ++k) {
        const LaneLight& light = context.scratch.light[k];
        Estimate& e = estimates_[batch_[k]];
        for (std::size_t i = 0; i < ray_of_[k].size(); ++i) {
            const std::uint16_t ray = ray_of_[k][i];
            const Rgb through = ray == no_ray ? Rgb(0.0f) : rays_[ray].transmittance;
            e.r[i] = light.r[i] * through.x, e.g[i] = light.g[i] * through.y;
            e.b[i] = light.b[i] * through.z;
        }
        record(batch_[k]);
        add_to_total(e, 1.0);
    }
    in_batch_ = 0;
}

}  // namespace mote::lights
