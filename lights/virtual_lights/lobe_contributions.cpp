#include "lights/virtual_lights/lobe_contributions.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int lobe_lanes = ReceiverLanes::width;

/// |g| and the preferred direction of a light; g = 0: its intensity is all.
struct LightLobe {
    float g = 0.0f;
    Vec3 preferred{0.0f};
};

/// Nothing where the light is neither plain nor of Henyey-Greenstein's function.
std::optional<LightLobe> lobe_of(const VplSet& vpls, const VirtualPointLight& y) {
    if (y.detail == VirtualPointLight::no_detail) return LightLobe{};
    const ScatteringVertex& v = vpls.details[y.detail].vertex;
    const auto g = v.phase ? v.phase->henyey_greenstein() : std::nullopt;
    if (g.value_or(0.0f) == 0.0f) return std::nullopt;
    return LightLobe{std::fabs(*g), *g > 0.0f ? -v.wo : v.wo};
}

/// Henyey-Greenstein's function for h = 1 - cos (media/henyey_greenstein.h), without a branch.
inline float lobe(float g, float h) {
    const float d = (1.0f - g) * (1.0f - g) + 2.0f * g * h;
    return inv_four_pi * (1.0f - g) * (1.0f + g) / (d * std::sqrt(d));
}

/// As plain_contributions().
bool contributions(const ReceiverLanes& x, const ReceiverLobes& lobes, const VirtualPointLight& y,
                   const LightLobe& light, float light_weight, const BoundedGeometry& weight,
                   ShadowPacket& packet, LaneLight& out) {
    const float y_in_medium = y.on_surface() ? 0.0f : 1.0f;
    const float px = y.position.x, py = y.position.y, pz = y.position.z;
    const float nx = y.normal.x, ny = y.normal.y, nz = y.normal.z;
    const float sx = y.shading_normal.x, sy = y.shading_normal.y, sz = y.shading_normal.z;
    const Rgb intensity = y.intensity * light_weight;
    const float ir = intensity.x, ig = intensity.y, ib = intensity.z;
    const float gy = light.g, lx = light.preferred.x, ly = light.preferred.y, lz = light.preferred.z;
    const float y_has_lobe = gy > 0.0f ? 1.0f : 0.0f;
    const auto depth = std::int32_t(y.depth);
    const float bound = weight.bound;
    float brightest = 0.0f;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lobe_lanes; ++i) {
        const float dx = px - x.x[i], dy = py - x.y[i], dz = pz - x.z[i];
        const float d2 = max_of(dx * dx + dy * dy + dz * dz, min_distance_squared);
        const float inv_d = 1.0f / std::sqrt(d2);
        const float wx = dx * inv_d, wy = dy * inv_d, wz = dz * inv_d;
        const float side_x = wx * x.geometric_x[i] + wy * x.geometric_y[i] + wz * x.geometric_z[i];
        const float cos_x = wx * x.shading_x[i] + wy * x.shading_y[i] + wz * x.shading_z[i];
        const float cos_y = -(wx * nx + wy * ny + wz * nz);
        const float side_y = -(wx * sx + wy * sy + wz * sz);
        const float c_x = min_of(side_x, cos_x) > 0.0f ? cos_x : x.in_medium[i];
        const float c_y = min_of(side_y, cos_y) > 0.0f ? cos_y : y_in_medium;
        // h is half the square of the difference of unit vectors.
        const float ax = lobes.x[i] - wx, ay = lobes.y[i] - wy, az = lobes.z[i] - wz;
        const float bx = lx + wx, by = ly + wy, bz = lz + wz;
        const float f_x = lobe(lobes.g[i], 0.5f * (ax * ax + ay * ay + az * az));
        const float f_y = lobe(gy, 0.5f * (bx * bx + by * by + bz * bz));
        const float f = (lobes.g[i] > 0.0f ? f_x : 1.0f) * (y_has_lobe > 0.0f ? f_y : 1.0f);
        const float weighted_g = f * min_of(c_x * c_y * (inv_d * inv_d), bound);
        const float weighted = depth <= x.max_vpl_depth[i] ? weighted_g : 0.0f;
        const float r = x.weight_r[i] * ir * weighted;
        const float g = x.weight_g[i] * ig * weighted;
        const float b = x.weight_b[i] * ib * weighted;
        out.r[i] = r, out.g[i] = g, out.b[i] = b;
        const bool lit = max_of(r, max_of(g, b)) > 0.0f;
        const float end = shadow_fraction(x.position(i), inv_d);
        packet.set(i, x.position(i), {dx, dy, dz}, lit ? end : -1.0f);
    }
    for (int i = 0; i < lobe_lanes; ++i) brightest = max_of(brightest, packet.t_max[i]);
    return brightest > 0.0f;
}

}  // namespace

ReceiverLobes::ReceiverLobes(const ReceiverLanes& receivers) {
    for (int i = 0; i < lobe_lanes; ++i) {
        const ScatteringVertex* v = receivers.directional[i];
        if (!v || receivers.max_vpl_depth[i] == 0) continue;
        const auto hg = v->phase ? v->phase->henyey_greenstein() : std::nullopt;
        known &= hg.value_or(0.0f) != 0.0f;
        if (!known) return;
        const Vec3 preferred = *hg > 0.0f ? -v->wo : v->wo;
        g[i] = std::fabs(*hg), x[i] = preferred.x, y[i] = preferred.y, z[i] = preferred.z;
    }
}

bool lobe_contributions(const VplSet& vpls, const WeightedVpl& light, const ReceiverLanes& receivers,
                        const ReceiverLobes& lobes, const BoundedGeometry& weight, ShadowPacket& packet,
                        LaneLight& out) {
    const VirtualPointLight& vpl = vpls.lights[light.index];
    const bool plain = vpl.detail == VirtualPointLight::no_detail && !receivers.any_directional;
    // Roughness that is clamped pair by pair has no lobe of its own.
    const bool quick = !plain && lobes.known && vpls.peak_density.empty();
    const auto own = quick ? lobe_of(vpls, vpl) : std::nullopt;
    if (!own) return contributions_of(vpls, light, receivers, weight, packet, out);
    out.receivers = &receivers, out.vpl = light.index;
    return contributions(receivers, lobes, vpl, *own, light.weight, weight, packet, out);
}

}  // namespace mote::lights
