#include "lights/selection/hierarchy/vertex_bounds.h"

#include "media/henyey_greenstein.h"

namespace mote::lights {

using namespace core;

namespace {

/// A lobe that the albedo does not contain still has a chance to be sampled.
constexpr float min_albedo = 0.02f;

/// At least the phase function's value towards any wi of the cone.
float phase_bound(const PhaseFunction& phase, const Vec3& wo, const DirectionCone& wi) {
    const auto g = phase.henyey_greenstein();
    if (!g) return infinity;
    const Vec3 preferred = *g > 0.0f ? -wo : wo;
    const float between =
        std::atan2(glm::length(glm::cross(preferred, wi.axis)), glm::dot(preferred, wi.axis));
    const float least = std::max(0.0f, between - wi.angle - 1e-5f);
    return (1.0f + 1e-4f) * media::henyey_greenstein(std::fabs(*g), 2.0f * sqr(std::sin(0.5f * least)));
}

void set_g(LightNode& node, float a) {
    node.g_low = std::uint16_t(std::floor(a * 65535.0f)),
    node.g_high = std::uint16_t(std::ceil(a * 65535.0f));
}

/// At least f* times the cosine to the geometric normal, for any direction on its side. Where the cosine to
/// the shading normal is at least c, f* is at most its bound over a cone, and where it is at most c' the
/// other cosine is at most c' + sin(angle between the normals).
float peak_times_cosine(const ScatteringVertex& v, const Vec3& wo, float most) {
    const float side = wo.z < 0.0f ? -1.0f : 1.0f;
    const float between = glm::length(glm::cross(v.hit.shading.n, v.hit.geometric_normal)) + 1e-5f;
    float result = 0.0f, high = 1.0f;
    for (int k = 0; k < 7 && most < infinity; ++k, high *= 0.5f) {
        const DirectionCone cone{{0.0f, 0.0f, side}, std::acos(0.5f * high)};
        const float f = max_component(v.bsdf->eval_bound(v.bsdf_point(), wo, cone));
        result = std::max(result, f * std::min(1.0f, high + between));
    }
    return std::min(most, std::max(result, most * std::min(1.0f, high + between)));
}

void describe_surface(LightNode& node, const VplDetail& detail, const Rgb& alpha) {
    const ScatteringVertex& v = detail.vertex;
    const Vec3 wo = v.hit.shading.to_local(v.wo);
    const float correction = detail.incoming_correction() / v.stop_chance;
    const float albedo = std::max(average(v.bsdf->albedo(v.bsdf_point(), wo)), min_albedo);
    const float constant = albedo * inv_pi * correction;
    node.energy = alpha * constant;
    const float most = max_component(v.bsdf->eval_bound(v.bsdf_point(), wo, DirectionCone::all()));
    const float scale = constant > 0.0f ? correction / constant : 0.0f;
    node.peak = most * scale;
    node.kind = v.bsdf->traits().transmissive ? LightKind::mixed : LightKind::glossy;
    if (node.kind == LightKind::glossy) node.set_grazing(scale * peak_times_cosine(v, wo, most));
}

void describe_volume(LightNode& node, const VplDetail& detail, const Rgb& alpha) {
    const ScatteringVertex& v = detail.vertex;
    node.energy = alpha * inv_four_pi;
    const auto g = v.phase->henyey_greenstein();
    node.kind = g ? LightKind::volume : LightKind::mixed;
    node.peak = 4.0f * pi * phase_bound(*v.phase, v.wo, DirectionCone::all());
    if (!g) return;
    set_g(node, std::fabs(*g));
    node.set_cone(DirectionCone::of(*g > 0.0f ? -v.wo : v.wo));
}

}  // namespace

Rgb eval_bound(const ScatteringVertex& vertex, const DirectionCone& wi) {
    if (vertex.phase) return Rgb(phase_bound(*vertex.phase, vertex.wo, wi));
    const Frame& frame = vertex.hit.shading;
    return vertex.bsdf->eval_bound(vertex.bsdf_point(), frame.to_local(vertex.wo),
                                   {frame.to_local(wi.axis), wi.angle}) /
           vertex.stop_chance;
}

LightNode VplLeaves::leaf(std::uint32_t light) const {
    const VirtualPointLight& vpl = vpls_.lights[light];
    LightNode node;
    node.lower = node.upper = vpl.position;
    node.min_depth = std::uint16_t(std::min(vpl.depth, 0xffffu));
    node.energy = vpl.intensity;
    node.kind = vpl.on_surface() ? LightKind::surface : LightKind::volume;
    node.set_cone(vpl.on_surface() ? DirectionCone::of(vpl.normal) : DirectionCone::all());
    if (vpl.detail == VirtualPointLight::no_detail) return node;
    const VplDetail& detail = vpls_.details[vpl.detail];
    if (vpl.on_surface())
        describe_surface(node, detail, vpl.intensity);
    else
        describe_volume(node, detail, vpl.intensity);
    if (node.kind == LightKind::mixed) node.set_cone(DirectionCone::all());
    // The geometry of a detailed light starts at its vertex, the shadow ray beside it.
    node.lower = glm::min(node.lower, detail.vertex.position);
    node.upper = glm::max(node.upper, detail.vertex.position);
    return node;
}

}  // namespace mote::lights
