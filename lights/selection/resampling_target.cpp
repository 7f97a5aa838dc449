#include "lights/selection/resampling_target.h"

#include "lights/selection/cluster_bounds.h"
#include "lights/selection/vertex_bounds.h"

namespace mote::lights {

using namespace core;

namespace {

/// Weights are sums of such numbers times few hundred: below infinity, since a receiver may stand on a light.
constexpr float largest = 1e28f;

/// `fast`: 1 where e^-t is the transmittance, 0 where t is a guess itself.
inline float guessed_transmittance(float t, float fast) {
    return 1.0f / (1.0f + t * (1.0f + fast * t * (0.5f + t * (1.0f / 6.0f))));
}

}  // namespace

ResamplingTarget::ResamplingTarget(const VplSet& vpls, const ReceiverTile& tile, float bound, bool attenuates,
                                   bool exact)
    : vpls_(&vpls), tile_(&tile), bound_{bound} {
    if (!exact) lobes_.emplace(tile);
    if (lobes_ && lobes_->any_glossy) lobes_.reset();
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        const float weight = luminance(Rgb(tile.weight_r[i], tile.weight_g[i], tile.weight_b[i]));
        scale_[i] = tile.max_vpl_depth[i] != 0 && weight > 0.0f ? 1.0f / weight : 0.0f;
        const Medium* medium = attenuates && scale_[i] > 0.0f ? tile.state[i].current() : nullptr;
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

/// Is this light, or any receiver, a lobe in a medium, and none of them a glossy surface?
bool ResamplingTarget::lobes_at_once(const VirtualPointLight& light) const {
    const bool detailed = light.detail != VirtualPointLight::no_detail;
    return lobes_ && (detailed || tile_->any_directional) && !(detailed && light.on_surface());
}

bool ResamplingTarget::expected(const WeightedVpl& light, Lanes& out) const {
    const Vec3 position = vpls_->lights[light.index].position;
    const LaneValues sent =
        expected_light(VplLeaves(*vpls_).leaf(std::uint32_t(light.index)), *lobes_, bound_.bound);
    const float there = extinction_at(position);
    float brightest = 0.0f;
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        const float dx = position.x - tile_->x[i], dy = position.y - tile_->y[i],
                    dz = position.z - tile_->z[i];
        const float t = std::sqrt(dx * dx + dy * dy + dz * dz) * (own_half_[i] + other_half_[i] * there);
        const float value = sent.value[i] * light.weight * guessed_transmittance(t, fast_);
        out[i] = value > 0.0f ? min_of(value, largest) : 0.0f;
        brightest = max_of(brightest, out[i]);
    }
    return brightest > 0.0f;
}

bool ResamplingTarget::of_light(const WeightedVpl& light, GatherScratch& scratch, Lanes& out) const {
    if (lobes_at_once(vpls_->lights[light.index])) return expected(light, out);
    ShadowPacket& ray = scratch.packets[0];
    LaneLight& sent = scratch.light[0];
    if (!contributions_of(*vpls_, light, *tile_, bound_, ray, sent)) return false;
    const float there = extinction_at(vpls_->lights[light.index].position);
    for (std::size_t i = 0; i < std::size_t(width); ++i) {
        const float dx = ray.direction_x[i], dy = ray.direction_y[i], dz = ray.direction_z[i];
        const float t = std::sqrt(dx * dx + dy * dy + dz * dz) * (own_half_[i] + other_half_[i] * there);
        const float value = luminance(Rgb(sent.r[i], sent.g[i], sent.b[i])) * guessed_transmittance(t, fast_);
        out[i] = ray.t_max[i] > 0.0f ? min_of(value, largest) : 0.0f;
    }
    return true;
}

ResamplingTarget::Connection ResamplingTarget::of_lane(int lane, std::size_t light) const {
    const VirtualPointLight& vpl = vpls_->lights[light];
    if (std::int32_t(vpl.depth) > tile_->max_vpl_depth[lane]) return {};
    const LaneConnection c = lane_connection(*tile_, lane, *vpls_, vpl, 1.0f);
    const float g = c.cos_x * c.cos_y / c.distance_squared;
    Connection connection{c.value * weigh(bound_, g, c.distance_squared, c.cos_x, c.cos_y, lane), c.origin,
                          c.target, 0.0f};
    const auto i = std::size_t(lane);
    const float t = std::sqrt(c.distance_squared) *
                    (own_half_[i] + (medium_ ? other_half_[i] * extinction_at(vpl.position) : 0.0f));
    connection.value = min_of(luminance(connection.light) * guessed_transmittance(t, fast_), largest);
    return connection;
}

}  // namespace mote::lights
