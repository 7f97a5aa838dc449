#include "lights/ray_lights/line_gather.h"

#include <algorithm>
#include <cmath>

namespace mote::lights {

using namespace core;

namespace {

constexpr int width = ReceiverLanes::width;

/// Points that fill the square, however many there are: multiples of powers of one over the plastic number,
/// whose cube is itself plus 1 (Roberts 2018), from a random start.
Vec2 spread(const Vec2& start, std::size_t n) {
    const double x = double(start.x) + 0.7548776662466927 * double(n),
                 y = double(start.y) + 0.5698402909980532 * double(n);
    constexpr float last = 1.0f - 0x1p-24f;
    return {std::fmin(float(x - std::floor(x)), last), std::fmin(float(y - std::floor(y)), last)};
}

void set_lane(ShadowPacket& packet, LaneLight& light, int i, const LineConnection& c, float weight) {
    packet.set_segment(i, c.from, c.to);
    light.r[i] = weight * c.value.x, light.g[i] = weight * c.value.y, light.b[i] = weight * c.value.z;
}

/// One of a point, the lane of a tile, and a VPL.
std::optional<LineConnection> connect_point(const ReceiverTile& tile, int lane, const VplSet& vpls,
                                            const VirtualPointLight& vpl, float bound) {
    if (std::int32_t(vpl.depth) > tile.max_vpl_depth[lane]) return std::nullopt;
    const lights::LaneConnection c = lane_connection(tile, lane, vpls, vpl, 1.0f);
    const Rgb value = c.value * std::fmin(c.cos_x * c.cos_y / c.distance_squared, bound);
    if (!(max_component(value) > 0.0f)) return std::nullopt;
    return LineConnection{value, c.origin, c.target};
}

}  // namespace

void LineGather::sample_candidates(Rng& rng, int receivers) {
    constexpr std::size_t least = 8;
    const std::size_t count =
        std::min(candidates_, std::max(least, candidates_ * std::size_t(receivers) / std::size_t(width)));
    PowerSampling(set_.ray_power, count).choose_all(rng.next_float(), candidate_rays_);
    PowerSampling(set_.surface_power, count).choose_all(rng.next_float(), candidate_vpls_);
}

template <typename Receivers>
void LineGather::evaluate_at(const Receivers& receivers, LineCandidates& candidates) const {
    Lanes expected;
    for (const WeightedVpl& light : candidate_rays_) {
        importance(set_.rays[light.index], receivers, expected);
        candidates.add(std::uint32_t(light.index), true, light.weight, expected);
    }
    for (const WeightedVpl& light : candidate_vpls_) {
        importance(set_.surface.lights[light.index], receivers, expected);
        candidates.add(std::uint32_t(light.index), false, light.weight, expected);
    }
}

void LineGather::evaluate(const EyeLines& eyes, LineCandidates& candidates) const {
    evaluate_at(EyeReceivers(eyes), candidates);
}

void LineGather::evaluate(const PointReceivers& points, LineCandidates& candidates) const {
    evaluate_at(points, candidates);
}

template <typename Active>
void LineGather::choose(const LineCandidates& candidates, const Lanes& steps, ReceiverTile& tile,
                        const Active& active) {
    Lanes starts;
    for (int i = 0; i < width; ++i) starts[i] = active(i) ? tile.rng[i].next_float() : 1.0f;
    candidates.choose(steps, starts, choices_);
}

/// connect_lane(lane, pick, u) -> optional<LineConnection>.
template <typename Connect>
TileLight LineGather::gather(ReceiverTile& tile, const Connect& connect_lane) {
    std::array<Vec2, width> starts;
    std::size_t most = 0;
    for (std::size_t i = 0; i < choices_.size(); ++i) {
        most = std::max(most, choices_[i].size());
        if (!choices_[i].empty()) starts[i] = tile.rng[i].next_vec2();
    }
    TracedVisibility visibility(context_, tile);
    TileSum sum;
    std::size_t batched = 0;
    const auto resolve = [&] {
        if (batched == 0) return;
        const auto light = std::span(context_.scratch.light).first(batched);
        visibility(std::span(context_.scratch.packets).first(batched), light);
        for (const LaneLight& l : light) sum.add(l);
        batched = 0;
    };
    for (std::size_t n = 0; n < most; ++n) {
        ShadowPacket& packet = context_.scratch.packets[batched];
        LaneLight& light = context_.scratch.light[batched];
        bool any = false;
        for (std::size_t i = 0; i < choices_.size(); ++i) {
            packet.t_max[i] = -1.0f;
            light.r[i] = light.g[i] = light.b[i] = 0.0f;
            if (n >= choices_[i].size()) continue;
            const LineChoice& pick = choices_[i][n];
            ++counters_.pairs;
            if (const Found found = connect_lane(int(i), pick, spread(starts[i], n))) {
                set_lane(packet, light, int(i), *found, pick.weight);
                ++counters_.connected, any = true;
            }
        }
        if (any && ++batched == GatherScratch::batch) resolve();
    }
    resolve();
    return sum.value();
}

TileLight LineGather::to_eyes(const EyeLines& eyes, const LineCandidates& candidates, const Lanes& steps,
                              ReceiverTile& tile) {
    for (int i = 0; i < width; ++i) {
        tile.directional[i] = nullptr;
        if (const EyeLine* eye = eyes.of[std::size_t(i)]) tile.state[i] = eye->state;
    }
    choose(candidates, steps, tile, [&](int i) { return eyes.of[std::size_t(i)] != nullptr; });
    return gather(tile, [&](int i, const LineChoice& pick, const Vec2& u) -> Found {
        const EyeLine& eye = *eyes.of[std::size_t(i)];
        const LineContext context{tile.rng[i], context_.tracking};
        if (pick.ray) return connect(eye, set_.rays[pick.light], u, context);
        return connect(eye, set_.surface, set_.surface.lights[pick.light], u.x, context);
    });
}

TileLight LineGather::to_points(const LineCandidates& candidates, const Lanes& steps, float bound,
                                ReceiverTile& tile) {
    choose(candidates, steps, tile, [&](int i) { return tile.max_vpl_depth[i] > 0; });
    return gather(tile, [&](int i, const LineChoice& pick, const Vec2& u) -> Found {
        if (!pick.ray) return connect_point(tile, i, set_.surface, set_.surface.lights[pick.light], bound);
        return connect(tile, i, set_.rays[pick.light], u.x, bound, {tile.rng[i], context_.tracking});
    });
}

}  // namespace mote::lights
