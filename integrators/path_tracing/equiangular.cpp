#include "integrators/path_tracing/equiangular.h"

#include <algorithm>
#include <numbers>

#include "core/scene/transmittance_along.h"

namespace mote::integrators {

using namespace core;

std::optional<EquiangularSample> sample_equiangular(const Ray& ray, float t_max, const Vec3& light, float u) {
    if (!(ray.t_min < t_max)) return std::nullopt;
    const Vec3d to_light = Vec3d(light) - Vec3d(ray.origin), direction(ray.direction);
    const double nearest = glm::dot(to_light, direction);
    // A light on the ray: any positive D gives a valid density; one below what single
    // precision resolves would crowd the samples into a few points.
    const double distance = glm::length(to_light);
    const double D = std::max(glm::length(to_light - nearest * direction), 1e-4 * distance + 1e-30);
    const double theta_a = std::atan2(double(ray.t_min) - nearest, D);
    // Half of pi in single precision is more than half of pi: beyond it the tangent begins at minus infinity.
    const double theta_b =
        std::isfinite(t_max) ? std::atan2(double(t_max) - nearest, D) : 0.5 * std::numbers::pi;
    if (!(theta_a < theta_b)) return std::nullopt;
    const double s = D * std::tan(theta_a + (theta_b - theta_a) * double(u));
    const double pdf = D / ((theta_b - theta_a) * (D * D + s * s));
    const float t =
        std::clamp(float(nearest + s), ray.t_min, std::min(t_max, std::numeric_limits<float>::max()));
    if (!(pdf > 0.0) || !std::isfinite(float(pdf))) return std::nullopt;
    return EquiangularSample{t, float(pdf)};
}

EquiangularLights::EquiangularLights(const Scene& scene) {
    std::vector<LightBounds> bounds;
    for (const auto& emitter : scene.emitters()) {
        const auto position = Scene::light_position(*emitter);
        if (!position || !(average(emitter->power()) > 0.0f)) continue;
        lights_.push_back({emitter.get(), *position, {}});
        if (const auto* spot = dynamic_cast<const lights::ConeLight*>(emitter.get()))
            lights_.back().cone = spot->cone();
        bounds.push_back(emitter->bounds().value_or(LightBounds{
            .box = {*position, *position}, .intensity = double(average(emitter->power()) * inv_four_pi)}));
    }
    choice_ = LightTree(bounds);
}

Rgb EquiangularLights::scattered_along(const Scene& scene, const Ray& ray, float t_max,
                                       const MediumState& state, const Vec2& u, WalkContext& context) const {
    if (lights_.empty()) return Rgb(0.0f);
    const auto choice =
        choice_.sample(LightSegment{ray.origin, ray.direction, ray.t_min, t_max}, double(u.x));
    const Light& light = lights_[choice.light];
    Ray lit = ray;
    lit.t_max = t_max;
    if (light.cone) {
        const auto inside = lights::inside_cone(*light.cone, ray, double(ray.t_min), double(t_max));
        if (!inside) return Rgb(0.0f);
        lit.t_min = float(inside->first), lit.t_max = float(inside->second);
    }
    const auto distance = sample_equiangular(lit, lit.t_max, light.position, u.y);
    if (!distance) return Rgb(0.0f);

    ScatteringVertex vertex;
    vertex.position = ray.at(distance->t), vertex.wo = -ray.direction;
    const auto to_light = light.emitter->sample_direct(vertex.position, Vec2(0.5f));
    if (!to_light) return Rgb(0.0f);
    TransmittanceAlong along(ray, state, context.boundary_hits, context.rng, context.tracking);
    const Rgb to_eye = along.advance_to(distance->t);
    const Medium* medium = along.state().current();
    if (!medium || is_black(to_eye)) return Rgb(0.0f);
    ++context.tracking.lookups;
    const Rgb sigma_s = medium->coefficients(vertex.position).sigma_s;
    if (is_black(sigma_s)) return Rgb(0.0f);
    vertex.phase = &medium->phase();

    Ray shadow{vertex.position, to_light->wi};
    shadow.t_max = to_light->distance;
    ++context.rays.occlusion;
    if (scene.rays().occluded(shadow)) return Rgb(0.0f);
    const Rgb from_light =
        scene.transmittance(vertex.position, light.position, along.state(), context.rng, context.tracking);
    const Rgb scattered = sigma_s * vertex.eval(to_light->wi, TransportMode::radiance);
    return to_eye * scattered * from_light * to_light->weight /
           (distance->pdf_distance * float(choice.probability));
}

}  // namespace mote::integrators
