#include "integrators/micro_rendering/micro_eye_tile.h"

namespace mote::integrators {

using namespace core;
using gathering::MicroReceiver;
using gathering::MicroTexel;

namespace {

/// Cells along a side of the table that a BSDF's warp is made of.
constexpr std::uint32_t warp_cells = 24;

}  // namespace

void MicroEyeTile::run(bool gathers) {
    packet_.run([&] {
        packet_.sample_lights();
        gather(gathers);
    });
}

/// True where a receiver is to gather light; records it for its neighbours.
bool MicroEyeTile::receives(Packet::Lane& lane) const {
    const EyePath<false>& path = *lane.path;
    // A light, a point, the receiver and the eye: two edges more.
    const bool fits = settings_.eye.max_depth < 0 || path.depth() + 2 <= settings_.eye.max_depth;
    if (!lane.alive || !path.vertex().connectable() || !fits || !settings_.eye.wanted[Transport::indirect])
        return false;
    see_receiver(lane.seen, path);
    if (settings_.glossy_upsampling && path.depth() == 1) lane.seen.surface.shared = true;
    return true;
}

void MicroEyeTile::gather(bool gathers) {
    std::array<Packet::Lane*, Packet::width> diffuse{}, glossy{};
    std::size_t diffuse_count = 0, glossy_count = 0;
    packet_.for_each([&](int, Packet::Lane& lane) {
        if (!receives(lane) || !gathers) return;
        const bool is_diffuse = lane.path->vertex().diffuse_reflectance().has_value();
        (is_diffuse ? diffuse[diffuse_count++] : glossy[glossy_count++]) = &lane;
    });
    packet_.walk().cancelled.check();
    receivers_ += diffuse_count + glossy_count;
    if (diffuse_count > 0) gather_diffuse(Lanes(diffuse).first(diffuse_count));
    if (glossy_count > 0) gather_glossy(Lanes(glossy).first(glossy_count));
}

MicroReceiver MicroEyeTile::receiver_of(Packet::Lane& lane) {
    return gathering::micro_receiver(lane.path->vertex(), lane.path->sampler().next_1d());
}

/// Gathers with texels of equal projected solid angles.
void MicroEyeTile::gather_diffuse(Lanes lanes) {
    group_.clear();
    for (Packet::Lane* lane : lanes) group_.push_back(receiver_of(*lane));
    const std::size_t each = points_.buffers().texels_each();
    points_.buffers().render(group_, std::span(texels_).first(lanes.size() * each));
    const float cosine_weight = points_.buffers().texels().cosine_weight();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
        const EyePath<false>& path = *lanes[k]->path;
        const ScatteringVertex& vertex = path.vertex();
        if (!(glm::dot(group_[k].frame.n, vertex.wo) > 0.0f)) continue;  // seen from below the shading normal
        const auto texels = std::span<const MicroTexel>(texels_).subspan(k * each, each);
        const Rgb light = inv_pi * *vertex.diffuse_reflectance() *
                          gathering::gathered(texels, cosine_weight, points_.radiance());
        lanes[k]->sum[Transport::indirect] += path.throughput() * light;
    }
}

/// Gathers with texels that are small where the BSDF reflects much (Engelhardt 2013, Sec. 8.1.3).
void MicroEyeTile::gather_glossy(Lanes lanes) {
    group_.clear(), warps_.clear();
    for (Packet::Lane* lane : lanes) {
        group_.push_back(receiver_of(*lane));
        const ScatteringVertex& vertex = lane->path->vertex();
        const Frame& frame = group_.back().frame;
        warps_.emplace_back(warp_cells, [&](const Vec3& wi) {
            return vertex.eval(frame.to_world(wi), TransportMode::radiance);
        });
    }
    const std::size_t each = points_.buffers().texels_each();
    points_.buffers().render_warped(group_, warps_, std::span(texels_).first(lanes.size() * each));
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
