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
    const Vec3 way = c.to - c.from;
    packet.origin_x[i] = c.from.x, packet.origin_y[i] = c.from.y, packet.origin_z[i] = c.from.z;
    packet.direction_x[i] = way.x, packet.direction_y[i] = way.y, packet.direction_z[i] = way.z;
    packet.t_min[i] = 0.0f, packet.t_max[i] = shadow_t_max;
    light.r[i] = weight * c.value.x, light.g[i] = weight * c.value.y, light.b[i] = weight * c.value.z;
}

/// So many VPLs are looked at for each that an eye ray connects to.
constexpr std::size_t candidates = 6;

/// What a VPL sends to an eye ray, about: intensity over distance, 0 only where all of the ray is below its
/// horizon.
float about(const EyeLine& eye, const VirtualPointLight& vpl) {
    const MediumLine& line = eye.line;
    const Vec3 to = vpl.position - line.origin, across = line.length * line.direction;
    if (vpl.detail == VirtualPointLight::no_detail && glm::dot(vpl.normal, to) >= 0.0f &&
        glm::dot(vpl.normal, to - across) >= 0.0f)
        return 0.0f;
    const float t = std::clamp(glm::dot(to, line.direction), 0.0f, line.length);
    const Vec3 off = to - t * line.direction;
    return average(vpl.intensity) / std::sqrt(glm::dot(off, off) + 1e-4f * sqr(line.length));
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
    return gather(rays_.count(), tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        const EyeLine* eye = eyes.of[std::size_t(i)];
        if (!eye) return std::nullopt;
        ++counters_.pairs;
        const WeightedVpl choice = rays_.choose(n, starts[std::size_t(i)]);
        const auto c = connect(*eye, set_.rays[choice.index], u, {tile.rng[i], context_.tracking, width_});
        return c ? Found({*c, choice.weight}) : std::nullopt;
    });
}

TileLight LineGather::vpls_to_eyes(const EyeLines& eyes, ReceiverTile& tile) {
    begin_eyes(eyes, tile);
    std::array<float, width> starts;
    for (int i = 0; i < width; ++i) starts[std::size_t(i)] = tile.rng[i].next_float();
    using Found = std::optional<std::pair<LineConnection, float>>;
    const std::size_t count = surface_.count();
    if (count == 0) return {};
    // As many candidates for each: where there are few lights, and where all are looked at, one.
    const std::size_t each = std::clamp(set_.surface.lights.size() / count, std::size_t(1), candidates);
    const LightShare offered(set_.surface_power, count * each);
    return gather(count, tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        const EyeLine* eye = eyes.of[std::size_t(i)];
        if (!eye) return std::nullopt;
        ++counters_.pairs;
        const auto choice = resample(*eye, offered, n * each, each, starts[std::size_t(i)], u.y);
        if (!(choice.weight > 0.0f)) return std::nullopt;
        const auto c = connect(*eye, set_.surface, set_.surface.lights[choice.index], u.x,
                               {tile.rng[i], context_.tracking});
        return c ? Found({*c, choice.weight}) : std::nullopt;
    });
}

/// One of `count` of the lights that are offered, from the n-th on, in proportion to what it would send to
/// the eye ray, about (resampled importance sampling, Talbot et al. 2005). Weight 0: none of them sends any.
WeightedVpl LineGather::resample(const EyeLine& eye, const LightShare& offered, std::size_t first,
                                 std::size_t count, float start, float u) const {
    if (count == 1) return offered.choose(first, start);
    WeightedVpl chosen{0, 0.0f};
    float sum = 0.0f, target = 0.0f;
    for (std::size_t n = first; n < first + count; ++n) {
        const WeightedVpl light = offered.choose(n, start);
        const float guess = about(eye, set_.surface.lights[light.index]), share = guess * light.weight;
        if (!(share > 0.0f)) continue;
        sum += share;
        if (u * sum < share)  // the same number may decide again: what is left of it is even
            chosen = light, target = guess, u = u * sum / share;
        else
            u = (u * sum - share) / (sum - share);
    }
    if (target > 0.0f) chosen.weight = sum / target;
    return chosen;
}

TileLight LineGather::rays_to_points(ReceiverTile& tile, float bound) {
    std::array<float, width> starts;
    for (int i = 0; i < width; ++i) starts[std::size_t(i)] = tile.rng[i].next_float();
    using Found = std::optional<std::pair<LineConnection, float>>;
    return gather(rays_.count(), tile, [&](int i, std::size_t n, const Vec2& u) -> Found {
        if (tile.max_vpl_depth[i] == 0) return std::nullopt;
        ++counters_.pairs;
        const WeightedVpl choice = rays_.choose(n, starts[std::size_t(i)]);
        const auto c =
            connect(tile, i, set_.rays[choice.index], u.x, bound, {tile.rng[i], context_.tracking, width_});
        return c ? Found({*c, choice.weight}) : std::nullopt;
    });
}

TileLight LineGather::vpls_to_points(ReceiverTile& tile, float bound) {
    int first = 0;  // a lane that is not idle: others have no generator of their own
    while (first + 1 < width && tile.max_vpl_depth[first] == 0) ++first;
    surface_.choose_all(tile.rng[first].next_float(), chosen_);
    return lights::gather(context_, set_.surface, DrawnVpls{chosen_}, BoundedGeometry{bound}, tile);
}

}  // namespace mote::lights
