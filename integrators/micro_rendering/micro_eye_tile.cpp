#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
using gathering::MicroReceiver;
using gathering::MicroTexel;

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
    std::array<MicroReceiver, width> receivers;
    std::array<Lane*, width> who{};
    std::size_t count = 0;
    for (Lane& lane : lanes_)
        if (lane.receives) {
            receivers[count] = gathering::micro_receiver(lane.path->vertex(), lane.path->sampler().next_1d());
            who[count++] = &lane;
        }
    if (count == 0) return;
    walk_.cancelled.check();
    receivers_ += count;
    const std::size_t each = points_.buffers().texels_each();
    const auto texels = std::span(texels_).first(count * each);
    points_.buffers().render(std::span(receivers).first(count), texels);
    for (std::size_t i = 0; i < count; ++i)
        who[i]->sum[Transport::indirect] += reflected(*who[i], receivers[i], texels.subspan(i * each, each));
}

Rgb MicroEyeTile::reflected(const Lane& lane, const MicroReceiver& receiver,
                            std::span<const MicroTexel> texels) const {
    const EyePath<false>& path = *lane.path;
    const ScatteringVertex& vertex = path.vertex();
    const auto weights = points_.buffers().texels().cosine_weights();
    if (const auto reflectance = vertex.diffuse_reflectance()) {
        if (!(glm::dot(receiver.frame.n, vertex.wo) > 0.0f)) return Rgb(0.0f);  // below the shading normal
        return path.throughput() * inv_pi * *reflectance *
               gathering::gathered(texels, weights, points_.radiance());
    }
    Rgb sum(0.0f);
    const auto directions = points_.buffers().texels().directions();
    for (std::size_t i = 0; i < texels.size(); ++i) {
        if (texels[i].empty()) continue;
        const Rgb light = points_.radiance().of(texels[i].node(), texels[i].from_behind());
        if (is_black(light)) continue;
        sum +=
            weights[i] * light * vertex.eval(receiver.frame.to_world(directions[i]), TransportMode::radiance);
    }
    return path.throughput() * sum;
}

}  // namespace mote::integrators
