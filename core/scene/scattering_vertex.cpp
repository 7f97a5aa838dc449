#include "core/scene/scattering_vertex.h"

namespace mote::core {
namespace {

/// True if shading and geometric normal agree on whether wo and wi lie on the same side.
bool sides_agree(const SurfaceHit& hit, const Vec3& wo, const Vec3& wi) {
    const float geometric = glm::dot(hit.geometric_normal, wo) * glm::dot(hit.geometric_normal, wi);
    const float shading = glm::dot(hit.shading.n, wo) * glm::dot(hit.shading.n, wi);
    return geometric * shading > 0.0f;
}

}  // namespace

Rgb ScatteringVertex::eval(const Vec3& wi, TransportMode mode, float peak_limit) const {
    if (phase) return phase->eval(wo, wi);
    if (!sides_agree(hit, wo, wi)) return Rgb(0.0f);
    BsdfPoint point = bsdf_point();
    point.peak_limit = peak_limit;
    return bsdf->eval(point, hit.shading.to_local(wo), hit.shading.to_local(wi), mode) / stop_chance;
}

Rgb ScatteringVertex::eval_cos(const Vec3& wi, TransportMode mode, float peak_limit) const {
    return eval(wi, mode, peak_limit) * shading_cosine(wi);
}

ScatteringValue ScatteringVertex::eval_cos_and_pdf(const Vec3& wi, TransportMode mode) const {
    if (phase) return {phase->eval(wo, wi), phase->pdf_solid_angle(wo, wi)};
    if (!sides_agree(hit, wo, wi)) return {Rgb(0.0f), 0.0f};
    const BsdfValue f =
        bsdf->eval_and_pdf(bsdf_point(), hit.shading.to_local(wo), hit.shading.to_local(wi), mode);
    return {f.value * (shading_cosine(wi) / stop_chance), f.pdf_solid_angle / stop_chance};
}

float ScatteringVertex::pdf_solid_angle(const Vec3& wi, TransportMode mode) const {
    if (phase) return phase->pdf_solid_angle(wo, wi);
    return bsdf->pdf_solid_angle(bsdf_point(), hit.shading.to_local(wo), hit.shading.to_local(wi), mode) /
           stop_chance;
}

std::optional<ScatterSample> ScatteringVertex::sample(float u_lobe, const Vec2& u, TransportMode mode) const {
    if (phase) {
        const PhaseSample s = phase->sample(wo, u);
        return ScatterSample{s.wi, s.weight, s.pdf_solid_angle};
    }
    // The chance to pass a pane was taken by the walk (ray_walk.cpp): what scatters lies below stop_chance.
    const auto s = bsdf->sample(bsdf_point(), hit.shading.to_local(wo), u_lobe * stop_chance, u, mode);
    if (!s || is_black(s->weight)) return std::nullopt;
    const Vec3 wi = glm::normalize(hit.shading.to_world(s->wi));
    if (!sides_agree(hit, wo, wi)) return std::nullopt;
    return ScatterSample{wi, s->weight, s->pdf_solid_angle / stop_chance, s->eta, s->delta, s->transmitted};
}

std::optional<Rgb> ScatteringVertex::diffuse_reflectance() const {
    auto reflectance = bsdf->diffuse_reflectance(bsdf_point(), hit.shading.to_local(wo));
    if (reflectance) *reflectance /= stop_chance;
    return reflectance;
}

MediumState ScatteringVertex::state_towards(const MediumState& state, const Vec3& direction) const {
    MediumState result = state;
    const auto crosses = [&] {
        return glm::dot(hit.geometric_normal, direction) * glm::dot(hit.geometric_normal, wo) < 0.0f;
    };
    if (on_surface() && hit.shape->has_medium_boundary && crosses())
        result.cross(*hit.shape, hit.geometric_normal, direction);
    return result;
}

ScatteringVertex make_vertex(const WalkEvent& event, const Ray& ray) {
    ScatteringVertex v;
    v.wo = -ray.direction;
    if (event.kind == WalkEvent::Kind::surface) {
        v.position = event.hit.position, v.hit = event.hit, v.bsdf = event.hit.shape->bsdf.get();
        v.stop_chance = event.stop_chance;
    } else {
        v.position = ray.at(event.distance), v.phase = &event.medium->phase();
    }
    return v;
}

float adjoint_correction(const ScatteringVertex& vertex, const Vec3& towards_light, const Vec3& away) {
    if (!vertex.on_surface()) return 1.0f;
    const Vec3 &ns = vertex.hit.shading.n, &ng = vertex.hit.geometric_normal;
    const float numerator = std::fabs(glm::dot(towards_light, ns) * glm::dot(away, ng));
    const float denominator = std::fabs(glm::dot(towards_light, ng) * glm::dot(away, ns));
    return denominator > 0.0f ? numerator / denominator : 0.0f;
}

}  // namespace mote::core
