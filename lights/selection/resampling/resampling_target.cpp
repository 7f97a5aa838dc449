#include "lights/selection/resampling/resampling_target.h"

namespace mote::lights {

using namespace core;

namespace {

/// Weights are sums of such numbers times few hundred: below infinity, since a receiver may stand on a VPL.
constexpr float largest = 1e28f;

/// `fast`: 1 where e^-t is the transmittance, 0 where t is a guess itself.
inline float guessed_transmittance(float t, float fast) {
    return 1.0f / (1.0f + t * (1.0f + fast * t * (0.5f + t * (1.0f / 6.0f))));
}

}  // namespace

ResamplingTarget::ResamplingTarget(const VplSet& vpls, const ReceiverTile& tile, float bound, bool attenuates)
    : vpls_(&vpls), tile_(&tile), bound_{bound}, lobes_(tile) {
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        const float weight = luminance(Rgb(tile.weight_r[i], tile.weight_g[i], tile.weight_b[i]));
        const bool active = tile.max_vpl_depth[i] != 0 && weight > 0.0f;
        const Medium* medium = attenuates && active ? tile.state[i].current() : nullptr;
        if (!medium) continue;
        if (!medium_) medium_ = medium, fast_ = medium->marching_step(1.0f, 1.0f) == infinity ? 1.0f : 0.0f;
        const float here = average(medium->coefficients(tile.position(int(i))).sigma_t);
        own_half_[i] = medium == medium_ ? 0.5f * here : here;
        other_half_[i] = medium == medium_ ? 0.5f : 0.0f;
    }
}

float ResamplingTarget::extinction_at(const Vec3& light) const {
    return medium_ ? average(medium_->coefficients(light).sigma_t) : 0.0f;
}

bool ResamplingTarget::of_light(const WeightedVpl& light, float extinction, GatherScratch& scratch,
                                Lanes& out) const {
    ShadowPacket& ray = scratch.packets[0];
    LaneLight& sent = scratch.light[0];
    if (!lobe_contributions(*vpls_, light, *tile_, lobes_, bound_, ray, sent)) return false;
    const float fast = fast_;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const float dx = ray.direction_x[i], dy = ray.direction_y[i], dz = ray.direction_z[i];
        const auto k = std::size_t(i);
        const float t = std::sqrt(dx * dx + dy * dy + dz * dz) * (own_half_[k] + other_half_[k] * extinction);
        const float value = luminance(Rgb(sent.r[i], sent.g[i], sent.b[i])) * guessed_transmittance(t, fast);
        out[k] = ray.t_max[i] > 0.0f ? min_of(value, largest) : 0.0f;
    }
    return true;
}

ResamplingTarget::Connection ResamplingTarget::of_lane(int lane, std::size_t light) const {
    const VirtualPointLight& vpl = vpls_->lights[light];
    if (std::int32_t(vpl.depth) > tile_->max_vpl_depth[lane]) return {};
    const LaneConnection c = lane_connection(*tile_, lane, *vpls_, vpl, 1.0f);
    const float g = c.cos_x * c.cos_y / c.distance_squared;
    Connection connection{c.value * weighted_geometry(bound_, g, c.distance_squared, c.cos_x, c.cos_y, lane),
                          c.origin, c.target, 0.0f};
    connection.value = min_of(luminance(connection.light), largest);
    return connection;
}

}  // namespace mote::lights
