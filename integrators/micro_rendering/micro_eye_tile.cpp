#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
using gathering::MicroReceiver;
using gathering::MicroTexel;

namespace {

/// Along a side of the table that a BSDF's warp is made of.
constexpr std::uint32_t warp_cells = 24;

}  // namespace

void MicroEyeTile::start(int index, const EyeRay& eye) {
    Lane& lane = lanes_[std::size_t(index)];
    lane.sum = {}, lane.seen = {}, lane.alive = true, lane.film = eye.film;
    walk_.rng = eye.rng;
    lane.path.emplace(scene_, settings_.eye, eye, walk_);
    lane.rng = walk_.rng;
}

void MicroEyeTile::stop(int index) {
    Lane& lane = lanes_[std::size_t(index)];
    lane.sum = {}, lane.alive = false;
}

void MicroEyeTile::run() {
    for (bool any = true; any;) {
        any = false;
        for (Lane& lane : lanes_) {
            lane.receives = false;
            if (lane.alive) lane.alive = advance(lane);
            any |= lane.alive;
        }
        gather();
    }
}

/// Follows one eye path to its next vertex; makes it a receiver where it can be connected. Returns whether
/// there is one.
bool MicroEyeTile::advance(Lane& lane) {
    walk_.rng = lane.rng;
    EyePath<false>& path = *lane.path;
    const bool at_vertex = path.advance(walk_, lane.sum);
    if (at_vertex && path.depth() == 1) lane.seen = see_first_leg(scene_, path, lane.film);
    if (at_vertex && path.depth() == 1 && !path.vertex().connectable()) lane.seen.share_nothing();
    if (at_vertex && path.vertex().connectable()) {
        if (path.wants_connection()) lane.sum[path.layer_of_connection()] += path.sample_light(walk_);
        // A light, a point, the receiver and the eye: two edges more.
        const bool fits = settings_.eye.max_depth < 0 || path.depth() + 2 <= settings_.eye.max_depth;
        if (fits && settings_.eye.wanted[Transport::indirect]) {
            see_receiver(lane.seen, path);
            if (settings_.glossy_upsampling && path.depth() == 1) lane.seen.surface.shared = true;
            lane.receives = gathers_;
        }
    }
    lane.rng = walk_.rng;
    return at_vertex;
}

void MicroEyeTile::gather() {
    std::array<Lane*, width> diffuse{}, glossy{};
    std::size_t diffuse_count = 0, glossy_count = 0;
    for (Lane& lane : lanes_) {
        if (!lane.receives) continue;
        const bool warped = settings_.warped && !lane.path->vertex().diffuse_reflectance();
        (warped ? glossy[glossy_count++] : diffuse[diffuse_count++]) = &lane;
    }
    walk_.cancelled.check();
    receivers_ += diffuse_count + glossy_count;
    if (diffuse_count > 0) gather_diffuse(std::span(diffuse).first(diffuse_count));
    if (glossy_count > 0) gather_glossy(std::span(glossy).first(glossy_count));
}

MicroReceiver MicroEyeTile::receiver_of(Lane& lane) {
    return gathering::micro_receiver(lane.path->vertex(), lane.path->sampler().next_1d());
}

/// Buffers of equal projected solid angles.
void MicroEyeTile::gather_diffuse(std::span<Lane* const> lanes) {
    place_.clear();
    for (Lane* lane : lanes) place_.push_back(receiver_of(*lane));
    const std::size_t each = points_.buffers().texels_each();
    points_.buffers().render(place_, std::span(texels_).first(lanes.size() * each));
    const auto cosines = points_.buffers().texels().cosine_weights();
    const auto directions = points_.buffers().texels().directions();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        const EyePath<false>& path = *lanes[k]->path;
        const ScatteringVertex& vertex = path.vertex();
        const auto texels = std::span<const MicroTexel>(texels_).subspan(k * each, each);
        const auto reflectance = vertex.diffuse_reflectance();
        Rgb light(0.0f);
        if (!reflectance) {
            for (std::size_t i = 0; i < each; ++i)
                weights_[i] = cosines[i] *
                              vertex.eval(place_[k].frame.to_world(directions[i]), TransportMode::radiance);
            light = gathering::gathered(texels, weights_, points_.radiance());
        } else if (glm::dot(place_[k].frame.n, vertex.wo) >
                   0.0f) {  // else seen from below the shading normal
            light = inv_pi * *reflectance * gathering::gathered(texels, cosines, points_.radiance());
        }
        lanes[k]->sum[Transport::indirect] += path.throughput() * light;
    }
}

/// Buffers whose texels are small where the BSDF reflects much.
void MicroEyeTile::gather_glossy(std::span<Lane* const> lanes) {
    place_.clear(), warps_.clear();
    for (Lane* lane : lanes) {
        place_.push_back(receiver_of(*lane));
        const ScatteringVertex& vertex = lane->path->vertex();
        const Frame& frame = place_.back().frame;
        warps_.emplace_back(warp_cells, [&](const Vec3& wi) {
            return vertex.eval(frame.to_world(wi), TransportMode::radiance);
        });
    }
    const std::size_t each = points_.buffers().texels_each();
    points_.buffers().render_warped(place_, warps_, std::span(texels_).first(lanes.size() * each));
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        if (warps_[k].black()) continue;
        warps_[k].fill_weights(points_.buffers().texels().side(), weights_);
        lanes[k]->sum[Transport::indirect] +=
            lanes[k]->path->throughput() *
            gathering::gathered(std::span<const MicroTexel>(texels_).subspan(k * each, each), weights_,
                                points_.radiance());
    }
}

}  // namespace mote::integrators
