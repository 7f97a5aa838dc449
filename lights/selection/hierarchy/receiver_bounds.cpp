#include "lights/selection/hierarchy/receiver_bounds.h"

#include "lights/selection/hierarchy/vertex_bounds.h"

namespace mote::lights {

using namespace core;

ReceiverBounds::ReceiverBounds(const ReceiverLanes& x) {
    for (int i = 0; i < width; ++i) {
        set_idle(i);
        if (x.max_vpl_depth[i] == 0) continue;
        max_vpl_depth[i] = x.max_vpl_depth[i], any_active = true;
        lower_x[i] = upper_x[i] = x.x[i], lower_y[i] = upper_y[i] = x.y[i], lower_z[i] = upper_z[i] = x.z[i];
        weight_r[i] = x.weight_r[i], weight_g[i] = x.weight_g[i], weight_b[i] = x.weight_b[i];
        if (const ScatteringVertex* vertex = x.directional[i])
            set_vertex(i, *vertex);
        else if (x.in_medium[i] == 0.0f) {
            set_cone(i, DirectionCone::of({x.shading_x[i], x.shading_y[i], x.shading_z[i]}));
            has_cosine[i] = 1.0f;
        }
    }
}

void ReceiverBounds::set_idle(int i) {
    lower_x[i] = lower_y[i] = lower_z[i] = upper_x[i] = upper_y[i] = upper_z[i] = 0.0f;
    weight_r[i] = weight_g[i] = weight_b[i] = has_cosine[i] = g_low[i] = g_high[i] = 0.0f;
    max_vpl_depth[i] = 0, glossy[i] = nullptr;
    set_cone(i, DirectionCone::all());
}

void ReceiverBounds::set_cone(int i, const DirectionCone& cone) {
    axis_x[i] = cone.axis.x, axis_y[i] = cone.axis.y, axis_z[i] = cone.axis.z;
    const bool some = cone.angle < pi;
    cos_angle[i] = some ? std::cos(cone.angle) : -1.0f, sin_angle[i] = some ? std::sin(cone.angle) : 0.0f;
}

DirectionCone ReceiverBounds::cone(int i) const {
    if (cos_angle[i] <= -1.0f) return DirectionCone::all();
    return {{axis_x[i], axis_y[i], axis_z[i]}, std::atan2(sin_angle[i], cos_angle[i])};
}

/// The vertex itself is where geometry is measured from; the shadow ray begins beside it.
void ReceiverBounds::set_vertex(int i, const ScatteringVertex& vertex) {
    const Vec3& p = vertex.position;
    lower_x[i] = upper_x[i] = p.x, lower_y[i] = upper_y[i] = p.y, lower_z[i] = upper_z[i] = p.z;
    const auto g = vertex.phase ? vertex.phase->henyey_greenstein() : std::nullopt;
    if (g) {
        g_low[i] = g_high[i] = std::fabs(*g), any_lobe = true;
        set_cone(i, DirectionCone::of(*g > 0.0f ? -vertex.wo : vertex.wo));
        weight_r[i] *= inv_four_pi, weight_g[i] *= inv_four_pi, weight_b[i] *= inv_four_pi;
        return;
    }
    glossy[i] = &vertex, any_glossy = true;
    if (!vertex.on_surface() || vertex.bsdf->traits().transmissive) return;
    const Vec3& n = vertex.hit.shading.n;
    set_cone(i, DirectionCone::of(glm::dot(n, vertex.wo) < 0.0f ? -n : n));
    has_cosine[i] = 1.0f;
}

/// Weights with what f* is at most in any direction.
Rgb ReceiverBounds::most(int i) const {
    const Rgb weight(weight_r[i], weight_g[i], weight_b[i]);
    return glossy[i] ? weight * eval_bound(*glossy[i], DirectionCone::all()) : weight;
}

ReceiverBounds::ReceiverBounds(const ReceiverBounds& a, const ReceiverBounds& b) {
    for (int i = 0; i < width; ++i) unite(i, a, b);
    any_active = a.any_active || b.any_active, any_lobe = a.any_lobe || b.any_lobe;
}

void ReceiverBounds::unite(int i, const ReceiverBounds& a, const ReceiverBounds& b) {
    set_idle(i);
    const bool has_a = a.max_vpl_depth[i] != 0, has_b = b.max_vpl_depth[i] != 0;
    if (!has_a && !has_b) return;
    const ReceiverBounds &p = has_a ? a : b, &q = has_b ? b : a;
    lower_x[i] = std::min(p.lower_x[i], q.lower_x[i]), upper_x[i] = std::max(p.upper_x[i], q.upper_x[i]);
    lower_y[i] = std::min(p.lower_y[i], q.lower_y[i]), upper_y[i] = std::max(p.upper_y[i], q.upper_y[i]);
    lower_z[i] = std::min(p.lower_z[i], q.lower_z[i]), upper_z[i] = std::max(p.upper_z[i], q.upper_z[i]);
    // One cone bounds both only where it is a cone of the same.
    const bool alike = p.has_cosine[i] == q.has_cosine[i] && (p.g_high[i] > 0.0f) == (q.g_high[i] > 0.0f);
    Rgb weight(0.0f);
    for (const ReceiverBounds* x : {&a, &b}) {
        if (x->max_vpl_depth[i] == 0) continue;
        const float g = x->g_high[i];
        const float lobe = alike ? 1.0f : (1.0f + g) / sqr(1.0f - g);
        weight += lobe * x->most(i);
    }
    weight_r[i] = weight.x, weight_g[i] = weight.y, weight_b[i] = weight.z;
    max_vpl_depth[i] = std::max(p.max_vpl_depth[i], q.max_vpl_depth[i]);
    if (!alike) return;
    has_cosine[i] = p.has_cosine[i];
    g_low[i] = std::min(p.g_low[i], q.g_low[i]), g_high[i] = std::max(p.g_high[i], q.g_high[i]);
    set_cone(i, united(p.cone(i), q.cone(i)));
}

float ReceiverBounds::diagonal2() const {
    float longest = 0.0f;
    for (int i = 0; i < width; ++i)
        longest = std::max(longest, sqr(upper_x[i] - lower_x[i]) + sqr(upper_y[i] - lower_y[i]) +
                                        sqr(upper_z[i] - lower_z[i]));
    return longest;
}

}  // namespace mote::lights
