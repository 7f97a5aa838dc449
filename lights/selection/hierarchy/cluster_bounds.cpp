#include "lights/selection/hierarchy/cluster_bounds.h"

#include "core/math/vectorize.h"
#include "lights/selection/hierarchy/cluster_cosines.h"
#include "lights/selection/hierarchy/difference_box.h"
#include "lights/selection/hierarchy/vertex_bounds.h"

namespace mote::lights {

using namespace core;

namespace {

constexpr int width = ReceiverLanes::width;
/// Rounding error of the product, at most.
constexpr float slack = 1.0f + 1e-4f;

/// Bsdf::eval_bound() of glossy lanes, with the cone of the directions in which the cluster is seen.
void apply_glossy(const LightNode& node, const ReceiverBounds& x, Lanes& out) {
    const Vec3 middle = 0.5f * node.lower + 0.5f * node.upper;
    const float radius = 0.5f * std::sqrt(node.diagonal2());
    for (int i = 0; i < width; ++i) {
        if (!x.glossy[i] || !(out[i] > 0.0f)) continue;
        const Vec3 d = middle - Vec3(x.lower_x[i], x.lower_y[i], x.lower_z[i]);
        const float length = glm::length(d);
        const bool outside = length > 1.0001f * radius;
        const DirectionCone cone =
            outside ? DirectionCone{d / length, std::asin(std::min(1.0f, radius / length)) + 1e-4f}
                    : DirectionCone::all();
        const Rgb most = eval_bound(*x.glossy[i], cone);
        // weight.energy is what the lanes have by now; channels of f* are joined by the largest.
        out[i] *= max_component(most);
    }
}

/// Times the largest values of the lobes of both ends, where there are any.
void apply_lobes(const LightNode& node, const ReceiverBounds& x, const float* cosine_x, const float* cosine_y,
                 Lanes& out) {
    const float g_low = float(node.g_low) * (1.0f / 65535.0f),
                g_high = float(node.g_high) * (1.0f / 65535.0f);
    if (node.kind == LightKind::volume && node.g_high > 0)
        for (int i = 0; i < width; ++i) out[i] *= slack * largest_lobe(g_low, g_high, cosine_y[i]);
    if (x.any_lobe)
        for (int i = 0; i < width; ++i)
            out[i] *= x.g_high[i] > 0.0f ? slack * largest_lobe(x.g_low[i], x.g_high[i], cosine_x[i]) : 1.0f;
}

/// At most, about, or both, which have nearly everything in common.
template <bool Most, bool About>
void light_of(const LightNode& node, const ReceiverBounds& x, float bound, Lanes& most, Lanes& about) {
    const Vec3 axis = node.axis();
    const float ax = axis.x, ay = axis.y, az = axis.z, cos_y_cone = node.cos_angle;
    const float sin_y_cone = safe_sqrt(1.0f - sqr(cos_y_cone));
    const float lx = node.lower.x, ly = node.lower.y, lz = node.lower.z;
    const float ux = node.upper.x, uy = node.upper.y, uz = node.upper.z;
    const float er = node.energy.x, eg = node.energy.y, eb = node.energy.z;
    const bool y_on_surface = node.kind == LightKind::surface || node.kind == LightKind::glossy;
    const float y_has_cosine = y_on_surface ? 1.0f : 0.0f;
    // The profile of glossy VPLs holds the cosine, and is 0 behind the surface.
    const float peak_times_cosine = node.peak_times_cosine();
    const float y_is_glossy = node.kind == LightKind::glossy ? 1.0f : 0.0f;
    const float min_d2 = max_of(0.25f * node.diagonal2(), min_distance_squared);
    const float peak = node.kind != LightKind::volume ? node.peak : 1.0f;
    const auto depth = std::int32_t(node.min_depth);
    const float own_bound = bound;
    float cosine_x[width], cosine_y[width];
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < width; ++i) {
        const DifferenceBox d{lx - x.upper_x[i], ly - x.upper_y[i], lz - x.upper_z[i],
                              ux - x.lower_x[i], uy - x.lower_y[i], uz - x.lower_z[i]};
        const float near2 = d.near_squared();
        const float inv_near = 1.0f / std::sqrt(near2), inv_far = 1.0f / std::sqrt(d.far_squared());
        const float to_light = d.largest_along(x.axis_x[i], x.axis_y[i], x.axis_z[i]);
        const float to_receiver = d.largest_along(-ax, -ay, -az);
        const float cx = largest_cosine(to_light, inv_near, inv_far, x.cos_angle[i], x.sin_angle[i]);
        const float cy = largest_cosine(to_receiver, inv_near, inv_far, cos_y_cone, sin_y_cone);
        const float c_x = max_of(max_of(cx, 0.0f), 1.0f - x.has_cosine[i]);
        const float c_y = max_of(max_of(cy, 0.0f), 1.0f - y_has_cosine);
        const float light = (x.weight_r[i] * er + x.weight_g[i] * eg + x.weight_b[i] * eb) * (1.0f / 3.0f);
        const float reached = depth <= x.max_vpl_depth[i] ? 1.0f : 0.0f;
        if constexpr (Most) {
            const float in_front = cy > 0.0f ? peak_times_cosine : 0.0f;
            const float y_end = max_of(in_front * y_is_glossy, c_y * (1.0f - y_is_glossy));
            const float g = min_of(c_x * y_end / near2, own_bound);
            const float sent = min_of(light * reached, g) > 0.0f ? light * g : 0.0f;
            most[i] = sent;
        }
        if constexpr (About) {
            const float g = min_of(c_x * c_y / d.middle_squared(min_d2), own_bound);
            const float sent = min_of(light * reached, g) > 0.0f ? light * g : 0.0f;
            about[i] = sent;
        }
        cosine_x[i] = cx, cosine_y[i] = cy;
    }
    if constexpr (Most) {
        for (float& v : most.value) v = v > 0.0f ? v * (slack * peak) : 0.0f;
        apply_lobes(node, x, cosine_x, cosine_y, most);
        if (x.any_glossy) apply_glossy(node, x, most);
    }
    if constexpr (About) {
        for (float& v : about.value) v *= slack;
        apply_lobes(node, x, cosine_x, cosine_y, about);
    }
}

}  // namespace

Lanes upper_bound(const LightNode& node, const ReceiverBounds& receivers, float bound) {
    Lanes most, about;
    light_of<true, false>(node, receivers, bound, most, about);
    return most;
}

Lanes importance(const LightNode& node, const ReceiverBounds& receivers, float bound) {
    Lanes most, about;
    light_of<false, true>(node, receivers, bound, most, about);
    return about;
}

void bound_and_importance(const LightNode& node, const ReceiverBounds& receivers, float bound, Lanes& most,
                          Lanes& expected) {
    light_of<true, true>(node, receivers, bound, most, expected);
}

}  // namespace mote::lights
