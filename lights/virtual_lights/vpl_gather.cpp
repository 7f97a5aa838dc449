#include "lights/virtual_lights/vpl_gather.h"

#include <algorithm>

#include "core/math/vectorize.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int width = ReceiverTile::width;
/// Shadow rays stop this much short of the VPL, so that rounding of the direction cannot hit the VPL's own
/// surface.
constexpr float shadow_t_max = 0.9999f;
/// A receiver exactly on a VPL: keeps 1/d^2 finite. Far below any distance that single precision resolves.
constexpr float min_distance_squared = 1e-30f;

inline float min_of(float a, float b) { return a < b ? a : b; }
inline float max_of(float a, float b) { return a > b ? a : b; }

/// Everything for receivers of constant f* and a plain VPL: branch-free over the sixteen lanes.
/// Returns whether any lane receives light.
bool connect_plain(const ReceiverLanes& tile, const VirtualPointLight& vpl, float bound, ShadowPacket& packet,
                   GatherScratch::Contribution& out) {
    const float vpl_in_medium = vpl.on_surface() ? 0.0f : 1.0f;
    const float px = vpl.position.x, py = vpl.position.y, pz = vpl.position.z;
    const float nx = vpl.normal.x, ny = vpl.normal.y, nz = vpl.normal.z;
    const float sx = vpl.shading_normal.x, sy = vpl.shading_normal.y, sz = vpl.shading_normal.z;
    const float ir = vpl.intensity.x, ig = vpl.intensity.y, ib = vpl.intensity.z;
    const auto depth = std::int32_t(vpl.depth);
    float lit[width];
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const float dx = px - tile.x[i], dy = py - tile.y[i], dz = pz - tile.z[i];
        const float d2 = max_of(dx * dx + dy * dy + dz * dz, min_distance_squared);
        const float inv_d = 1.0f / std::sqrt(d2);
        const float side = dx * tile.geometric_x[i] + dy * tile.geometric_y[i] + dz * tile.geometric_z[i];
        const float cos_x = dx * tile.shading_x[i] + dy * tile.shading_y[i] + dz * tile.shading_z[i];
        const float cos_y = -(dx * nx + dy * ny + dz * nz);
        const float side_y = -(dx * sx + dy * sy + dz * sz);
        // C* is the positive cosine on a surface and 1 in a medium; both sides of a shading normal must
        // agree.
        const float above_x = min_of(side, cos_x) > 0.0f ? cos_x * inv_d : tile.in_medium[i];
        const float above_y = min_of(side_y, cos_y) > 0.0f ? cos_y * inv_d : vpl_in_medium;
        const float g = above_x * above_y * (inv_d * inv_d);  // G* = C* C* / d^2
        const float g_bounded = depth <= tile.max_vpl_depth[i] ? min_of(g, bound) : 0.0f;
        const float r = tile.weight_r[i] * ir * g_bounded;
        const float gr = tile.weight_g[i] * ig * g_bounded;
        const float b = tile.weight_b[i] * ib * g_bounded;
        out.r[i] = r, out.g[i] = gr, out.b[i] = b;
        lit[i] = max_of(r, max_of(gr, b));
        packet.origin_x[i] = tile.x[i], packet.origin_y[i] = tile.y[i], packet.origin_z[i] = tile.z[i];
        packet.direction_x[i] = dx, packet.direction_y[i] = dy, packet.direction_z[i] = dz;
        packet.t_min[i] = 0.0f;
        packet.t_max[i] = lit[i] > 0.0f ? shadow_t_max : -1.0f;
    }
    float any = 0.0f;
    for (int i = 0; i < width; ++i) any = max_of(any, lit[i]);
    return any > 0.0f;
}

/// One lane of the general case: f* of the receiver, of the VPL, or of both depends on direction.
void connect_lane(const ReceiverLanes& tile, int i, const VplSet& vpls, const VirtualPointLight& vpl,
                  float bound, ShadowPacket& packet, GatherScratch::Contribution& out) {
    packet.t_max[i] = -1.0f;
    if (std::int32_t(vpl.depth) > tile.max_vpl_depth[i]) return;
    const ScatteringVertex* receiver = tile.directional[i];
    const VplDetail* detail =
        vpl.detail == VirtualPointLight::no_detail ? nullptr : &vpls.details[vpl.detail];
    const Vec3 x = receiver ? receiver->position : Vec3(tile.x[i], tile.y[i], tile.z[i]);
    const Vec3 y = detail ? detail->vertex.position : vpl.position;
    const float d2 = max_of(glm::dot(y - x, y - x), min_distance_squared);
    const Vec3 direction = (y - x) / std::sqrt(d2);

    Rgb value(tile.weight_r[i], tile.weight_g[i], tile.weight_b[i]);
    float cos_x = 1.0f, cos_y = 1.0f;
    if (receiver) {
        value *= receiver->eval(direction, TransportMode::radiance);
        cos_x = receiver->shading_cosine(direction);
    } else if (tile.in_medium[i] == 0.0f) {
        const Vec3 ns(tile.shading_x[i], tile.shading_y[i], tile.shading_z[i]);
        const Vec3 ng(tile.geometric_x[i], tile.geometric_y[i], tile.geometric_z[i]);
        cos_x = glm::dot(ng, direction) > 0.0f ? max_of(0.0f, glm::dot(ns, direction)) : 0.0f;
    }
    value *= vpl.intensity;
    if (detail) {
        value *= detail->eval(-direction);
        cos_y = detail->vertex.geometric_cosine(direction);
    } else if (vpl.on_surface()) {
        cos_y = glm::dot(vpl.shading_normal, direction) < 0.0f
                    ? max_of(0.0f, -glm::dot(vpl.normal, direction))
                    : 0.0f;
    }
    value *= min_of(cos_x * cos_y / d2, bound);
    if (!(max_component(value) > 0.0f)) return;
    out.r[i] = value.x, out.g[i] = value.y, out.b[i] = value.z;
    const Vec3 origin = receiver ? receiver->ray_origin(direction) : x;
    const Vec3 target = detail ? detail->vertex.ray_origin(-direction) : y;
    packet.origin_x[i] = origin.x, packet.origin_y[i] = origin.y, packet.origin_z[i] = origin.z;
    packet.direction_x[i] = target.x - origin.x, packet.direction_y[i] = target.y - origin.y;
    packet.direction_z[i] = target.z - origin.z;
    packet.t_min[i] = 0.0f, packet.t_max[i] = shadow_t_max;
}

bool connect_general(const ReceiverLanes& tile, const VplSet& vpls, const VirtualPointLight& vpl, float bound,
                     ShadowPacket& packet, GatherScratch::Contribution& out) {
    bool any = false;
    for (int i = 0; i < width; ++i) {
        out.r[i] = out.g[i] = out.b[i] = 0.0f;
        connect_lane(tile, i, vpls, vpl, bound, packet, out);
        any |= packet.t_max[i] > 0.0f;
    }
    return any;
}

/// Traces the batch and adds what is visible, times the transmittance where there are media.
void resolve_batch(const Scene& scene, int count, ReceiverTile& tile, GatherScratch& scratch,
                   std::array<Rgb, width>& sum, RayCounters& rays, TrackingCounters& tracking) {
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < width; ++i) rays.occlusion += scratch.packets[std::size_t(p)].t_max[i] > 0.0f;
    scene.rays().occluded(std::span(scratch.packets).first(std::size_t(count)));
    const bool attenuates = scene.attenuates();
    for (int p = 0; p < count; ++p) {
        const ShadowPacket& packet = scratch.packets[std::size_t(p)];
        const GatherScratch::Contribution& c = scratch.contributions[std::size_t(p)];
        for (int i = 0; i < width; ++i) {
            if (packet.occluded(i)) continue;  // idle lanes as well: their t_max was negative from the start
            Rgb value(c.r[i], c.g[i], c.b[i]);
            if (attenuates) {
                const Vec3 from(packet.origin_x[i], packet.origin_y[i], packet.origin_z[i]);
                const Vec3 to =
                    from + Vec3(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
                const ScatteringVertex* v = tile.directional[i];
                const MediumState state = v ? v->state_towards(tile.state[i], to - from) : tile.state[i];
                value *= scene.transmittance(from, to, state, tile.rng[i], tracking);
            }
            sum[std::size_t(i)] += value;
        }
    }
}

}  // namespace

GatherScratch::GatherScratch() {
    for (ShadowPacket& packet : packets) packet.clear();
}

void ReceiverTile::clear() {
    for (int i = 0; i < width; ++i) {
        max_vpl_depth[i] = 0, directional[i] = nullptr;
        weight_r[i] = weight_g[i] = weight_b[i] = 0.0f;
    }
    any_directional = any_active = false;
}

void ReceiverTile::set(int lane, const ScatteringVertex& vertex, const Rgb& throughput,
                       const MediumState& medium_state, const Rng& tracking_rng, std::int32_t max_depth) {
    Rgb weight = throughput;
    Vec3 position = vertex.position, ns(0.0f), ng(0.0f);
    directional[lane] = nullptr;
    if (vertex.on_surface()) {
        const bool front = glm::dot(vertex.hit.geometric_normal, vertex.wo) > 0.0f;
        ng = front ? vertex.hit.geometric_normal : -vertex.hit.geometric_normal;
        ns = front ? vertex.hit.shading.n : -vertex.hit.shading.n;
        position = offset_origin(vertex.hit, ng);
        const auto reflectance =
            vertex.bsdf->diffuse_reflectance(vertex.bsdf_point(), vertex.hit.shading.to_local(vertex.wo));
        if (!reflectance)
            directional[lane] = &vertex;
        else if (glm::dot(ns, vertex.wo) > 0.0f)
            weight *= *reflectance * inv_pi;
        else
            weight = Rgb(0.0f);  // seen from below the shading normal
    } else if (vertex.phase->isotropic()) {
        weight *= inv_four_pi;
    } else {
        directional[lane] = &vertex;
    }
    x[lane] = position.x, y[lane] = position.y, z[lane] = position.z;
    shading_x[lane] = ns.x, shading_y[lane] = ns.y, shading_z[lane] = ns.z;
    geometric_x[lane] = ng.x, geometric_y[lane] = ng.y, geometric_z[lane] = ng.z;
    in_medium[lane] = vertex.on_surface() ? 0.0f : 1.0f;
    weight_r[lane] = weight.x, weight_g[lane] = weight.y, weight_b[lane] = weight.z;
    max_vpl_depth[lane] = max_depth;
    state[lane] = medium_state;
    rng[lane] = tracking_rng;
    any_directional |= directional[lane] != nullptr;
    any_active = true;
}

bool connect(const ReceiverLanes& receivers, const VplSet& vpls, const VirtualPointLight& vpl, float bound,
             ShadowPacket& packet, GatherScratch::Contribution& out) {
    if (vpl.detail == VirtualPointLight::no_detail && !receivers.any_directional)
        return connect_plain(receivers, vpl, bound, packet, out);
    return connect_general(receivers, vpls, vpl, bound, packet, out);
}

std::array<Rgb, ReceiverTile::width> gather(const Scene& scene, const VplSet& vpls, const VplRange& range,
                                            float bound, ReceiverTile& tile, GatherScratch& scratch,
                                            RayCounters& rays, TrackingCounters& tracking) {
    std::array<Rgb, width> sum{};
    if (!tile.any_active) return sum;
    std::size_t count = 0;
    const std::size_t end = std::min(range.end, vpls.lights.size());
    for (std::size_t j = range.first; j < end; j += range.stride) {
        const VirtualPointLight& vpl = vpls.lights[j];
        ShadowPacket& packet = scratch.packets[count];
        GatherScratch::Contribution& contribution = scratch.contributions[count];
        contribution.vpl = &vpl;
        if (connect(tile, vpls, vpl, bound, packet, contribution) && ++count == GatherScratch::batch) {
            resolve_batch(scene, GatherScratch::batch, tile, scratch, sum, rays, tracking);
            count = 0;
        }
    }
    resolve_batch(scene, int(count), tile, scratch, sum, rays, tracking);
    return sum;
}

}  // namespace mote::lights
