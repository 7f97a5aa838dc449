#include "lights/ray_lights/line_gather.h"

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
    const Vec3 way = c.to - c.from;
    packet.origin_x[i] = c.from.x, packet.origin_y[i] = c.from.y, packet.origin_z[i] = c.from.z;
    packet.direction_x[i] = way.x, packet.direction_y[i] = way.y, packet.direction_z[i] = way.z;
    packet.t_min[i] = 0.0f, packet.t_max[i] = shadow_t_max;
    light.r[i] = weight * c.value.x, light.g[i] = weight * c.value.y, light.b[i] = weight * c.value.z;
}

}  // namespace

/// connect_lane(lane, n, u) -> optional<pair<LineConnection, weight>> for the n-th light.
template <typename Connect>
TileLight LineGather::gather(std::size_t count, ReceiverTile& tile, const Connect& connect_lane) {
    std::array<Vec2, width> starts;
    for (int i = 0; i < width; ++i) starts[std::size_t(i)] = tile.rng[i].next_vec2();
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
    for (std::size_t n = 0; n < count; ++n) {
        ShadowPacket& packet = context_.scratch.packets[batched];
        LaneLight& light = context_.scratch.light[batched];
        bool any = false;
        for (int i = 0; i < width; ++i) {
            packet.t_max[i] = -1.0f;
            light.r[i] = light.g[i] = light.b[i] = 0.0f;
            if (const auto found = connect_lane(i, n, spread(starts[std::size_t(i)], n))) {
                set_lane(packet, light, i, found->first, found->second);
                ++counters_.connected, any = true;
            }
        }
        if (any && ++batched == GatherScratch::batch) resolve();
    }
    resolve();
    return sum.value();
}

void LineGather::begin_eyes(const EyeLines& eyes, ReceiverTile& tile) const {
    for (int i = 0; i < width; ++i) {
        tile.directional[i] = nullptr;
        if (const EyeLine* eye = eyes.of[std::size_t(i)]) tile.state[i] = eye->state;
    }
}

TileLight LineGather::rays_to_eyes(const EyeLines& eyes, ReceiverTile& tile) {
    begin_eyes(eyes, tile);
    std::array<float, width> starts;
    for (int i = 0; i < width; ++i) starts[std::size_t(i)] = tile.rng[i].next_float();
    using Found = std::optional<std::pair<LineConnection, float>>;
    return gather(share_.count(), tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        const EyeLine* eye = eyes.of[std::size_t(i)];
        if (!eye) return std::nullopt;
        ++counters_.pairs;
        const RayLightChoice choice = share_.choose(n, starts[std::size_t(i)]);
        const auto c = connect(*eye, set_.rays[choice.index], u, {tile.rng[i], context_.tracking, width_});
        return c ? Found({*c, choice.weight}) : std::nullopt;
    });
}

TileLight LineGather::vpls_to_eyes(const EyeLines& eyes, const VplRange& range, ReceiverTile& tile) {
    begin_eyes(eyes, tile);
    const auto& lights = set_.surface.lights;
    const std::size_t count =
        range.first < lights.size() ? (lights.size() - range.first + range.stride - 1) / range.stride : 0;
    using Found = std::optional<std::pair<LineConnection, float>>;
    return gather(count, tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        const EyeLine* eye = eyes.of[std::size_t(i)];
        if (!eye) return std::nullopt;
        ++counters_.pairs;
        const VirtualPointLight& vpl = lights[range.first + n * range.stride];
        const auto c = connect(*eye, set_.surface, vpl, u.x, {tile.rng[i], context_.tracking});
        return c ? Found({*c, 1.0f}) : std::nullopt;
    });
}

TileLight LineGather::rays_to_surfaces(ReceiverTile& tile) {
    std::array<float, width> starts;
    for (int i = 0; i < width; ++i) starts[std::size_t(i)] = tile.rng[i].next_float();
    using Found = std::optional<std::pair<LineConnection, float>>;
    return gather(share_.count(), tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        if (tile.max_vpl_depth[i] == 0) return std::nullopt;
        ++counters_.pairs;
        const RayLightChoice choice = share_.choose(n, starts[std::size_t(i)]);
        const auto c =
            connect(tile, i, set_.rays[choice.index], u.x, {tile.rng[i], context_.tracking, width_});
        return c ? Found({*c, choice.weight}) : std::nullopt;
    });
}

}  // namespace mote::lights
