#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
using gathering::MicroReceiver;
using gathering::MicroTexel;

namespace {

/// Along a side of the table that a BSDF's warp is made of.
constexpr std::uint32_t warp_cells = 24;

}  // namespace

template <bool Media>
void MicroEyeTile<Media>::start(int index, const EyeRay& eye) {
    Lane& lane = lanes_[std::size_t(index)];
    lane.sum = {}, lane.seen = {}, lane.alive = true, lane.film = eye.film;
    walk_.rng = eye.rng;
    lane.path.emplace(scene_, settings_.eye, eye, walk_);
    lane.rng = walk_.rng;
}

template <bool Media>
void MicroEyeTile<Media>::stop(int index) {
    Lane& lane = lanes_[std::size_t(index)];
    lane.sum = {}, lane.alive = false;
}

template <bool Media>
void MicroEyeTile<Media>::run() {
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
template <bool Media>
bool MicroEyeTile<Media>::advance(Lane& lane) {
    walk_.rng = lane.rng;
    EyePath<Media>& path = *lane.path;
    const bool at_vertex = path.advance(walk_, lane.sum);
    if constexpr (!Media) {
        if (at_vertex && path.depth() == 1) lane.seen = see_first_segment(scene_, path, lane.film);
        if (at_vertex && path.depth() == 1 && !path.vertex().connectable()) lane.seen.share_nothing();
    }
    if (at_vertex && path.vertex().connectable()) {
        if (path.wants_connection()) lane.sum[path.layer_of_connection()] += path.sample_light(walk_);
        // A light, a point, the receiver and the eye: two edges more.
        const bool fits = settings_.eye.max_depth < 0 || path.depth() + 2 <= settings_.eye.max_depth;
        const Transport layer = transport_layer(2, path.vertex().on_surface());
        if (fits && settings_.eye.wanted[layer]) {
            if constexpr (!Media) see_receiver(lane.seen, path);
            if (settings_.glossy_upsampling && path.depth() == 1) lane.seen.surface.shared = true;
            lane.receives = gathers_;
        }
    }
    lane.rng = walk_.rng;
    return at_vertex;
}

template <bool Media>
void MicroEyeTile<Media>::gather() {
    std::array<Lane*, width> usual{}, other{};
    std::size_t usual_count = 0, other_count = 0;
    for (Lane& lane : lanes_) {
        if (!lane.receives) continue;
        const ScatteringVertex& vertex = lane.path->vertex();
        const bool apart = Media ? !vertex.on_surface() : settings_.warped && !vertex.diffuse_reflectance();
        (apart ? other[other_count++] : usual[usual_count++]) = &lane;
    }
    walk_.cancelled.check();
    receivers_ += usual_count + other_count;
    const auto first = std::span<Lane*const>(usual).first(usual_count),
               second = std::span<Lane*const>(other).first(other_count);
    if (usual_count > 0) Media ? gather_through_media(first) : gather_diffuse(first);
    if (other_count > 0) Media ? gather_in_media(second) : gather_glossy(second);
}

template <bool Media>
MicroReceiver MicroEyeTile<Media>::receiver_of(Lane& lane) {
    return gathering::micro_receiver(lane.path->vertex(), lane.path->sampler().next_1d());
}

/// Buffers of equal projected solid angles.
template <bool Media>
void MicroEyeTile<Media>::gather_diffuse(std::span<Lane* const> lanes) {
    place_.clear();
    for (Lane* lane : lanes) place_.push_back(receiver_of(*lane));
    const std::size_t each = points_.buffers().texels_each();
    points_.buffers().render(place_, std::span(texels_).first(lanes.size() * each));
    const auto cosines = points_.buffers().texels().cosine_weights();
    const auto directions = points_.buffers().texels().directions();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        const EyePath<Media>& path = *lanes[k]->path;
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
template <bool Media>
void MicroEyeTile<Media>::gather_glossy(std::span<Lane* const> lanes) {
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

/// Receivers on surfaces: buffers of equal projected solid angles, whatever the BSDF.
template <bool Media>
void MicroEyeTile<Media>::gather_through_media(std::span<Lane* const> lanes) {
    place_.clear();
    for (Lane* lane : lanes) place_.push_back(receiver_of(*lane));
    const gathering::FogBuffers& buffers = points_.volume()->hemispheres();
    const std::size_t each = buffers.texels_each();
    const auto all = std::span(radiance_).first(lanes.size() * each);
    buffers.render(place_, points_.radiance(), points_.volume()->light(), all, fog_);
    const auto cosines = buffers.surfaces().texels().cosine_weights();
    const auto directions = buffers.surfaces().texels().directions();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        const ScatteringVertex& vertex = lanes[k]->path->vertex();
        const auto radiance = std::span<const Rgb>(all).subspan(k * each, each);
        const auto reflectance = vertex.diffuse_reflectance();
        Rgb light(0.0f);
        if (!reflectance) {
            for (std::size_t i = 0; i < each; ++i)
                weights_[i] = cosines[i] *
                              vertex.eval(place_[k].frame.to_world(directions[i]), TransportMode::radiance);
            light = gathering::weighted(radiance, std::span<const Rgb>(weights_));
        } else if (glm::dot(place_[k].frame.n, vertex.wo) > 0.0f) {
            light = inv_pi * *reflectance * gathering::weighted(radiance, cosines);
        }
        lanes[k]->sum[Transport::indirect] += lanes[k]->path->throughput() * light;
    }
}

/// Receivers in media: two buffers of equal solid angles, weighed with the phase function.
template <bool Media>
void MicroEyeTile<Media>::gather_in_media(std::span<Lane* const> lanes) {
    const gathering::FogBuffers& buffers = points_.volume()->spheres();
    const std::size_t each = buffers.texels_each();
    const auto solid_angles = buffers.surfaces().texels().solid_angles();
    const auto directions = buffers.surfaces().texels().directions();
    const auto halves_of = std::span(radiance_).first(2 * each);
    for (Lane* lane : lanes) {
        const ScatteringVertex& vertex = lane->path->vertex();
        Sampler& sampler = lane->path->sampler();
        const Vec2 u = sampler.next_2d();
        const auto halves = gathering::sphere_receivers(vertex.position, u, sampler.next_1d());
        buffers.render(halves, points_.radiance(), points_.volume()->light(), halves_of, fog_);
        Rgb light(0.0f);
        for (std::size_t half = 0; half < halves.size(); ++half) {
            for (std::size_t i = 0; i < each; ++i)
                weights_[i] = solid_angles[i] * vertex.eval(halves[half].frame.to_world(directions[i]),
                                                            TransportMode::radiance);
            light += gathering::weighted(std::span<const Rgb>(halves_of).subspan(half * each, each),
                                         std::span<const Rgb>(weights_));
        }
        lane->sum[Transport::multiple_scattering] += lane->path->throughput() * light;
    }
}

template class MicroEyeTile<false>;
template class MicroEyeTile<true>;

}  // namespace mote::integrators
