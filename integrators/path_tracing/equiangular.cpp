#include "integrators/path_tracing/equiangular.h"

#include <algorithm>
#include <numbers>

#include "core/scene/transmittance_along.h"
#include "lights/emitters/even_angle.h"

namespace mote::integrators {

using namespace core;

std::optional<EquiangularSample> sample_equiangular(const Ray& ray, float t_max, const Vec3& light, float u) {
    if (!(ray.t_min < t_max)) return std::nullopt;
    const Vec3d to_light = Vec3d(light) - Vec3d(ray.origin), direction(ray.direction);
    const double nearest = glm::dot(to_light, direction);
    // A light on the ray: any positive D gives a valid density; one below what single
    // precision resolves would crowd the samples into a few points. Not far above that: directions around
    // lamps come as near, and a point nearer than D would be too bright for its density.
    const double distance = glm::length(to_light);
    const double D = std::max(glm::length(to_light - nearest * direction), 1e-6 * distance + 1e-30);
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

bool has_lamps_in_media(const Scene& scene) {
    return std::ranges::any_of(scene.emitters(), [&](const auto& light) {
        if (!Scene::light_position(*light) || is_black(light->power())) return false;
        const Medium* medium = scene.emitter_medium_state(*light, {}).current();
        return medium && medium->traits().scattering;
    });
}

EquiangularLights::EquiangularLights(const Scene& scene) {
    std::vector<LightBounds> bounds, everywhere;
    for (const auto& emitter : scene.emitters()) {
        const auto position = Scene::light_position(*emitter);
        if (!position || !(average(emitter->power()) > 0.0f)) continue;
        lights_.push_back({emitter.get(), *position, {}});
        if (const auto* spot = dynamic_cast<const lights::ConeLight*>(emitter.get()))
            lights_.back().cone = spot->cone();
        bounds.push_back(emitter->bounds().value_or(LightBounds{
            .box = {*position, *position}, .intensity = double(average(emitter->power()) * inv_four_pi)}));
        everywhere.push_back({.box = bounds.back().box, .intensity = bounds.back().intensity});
    }
    choice_ = LightTree(bounds), around_ = LightTree(everywhere);
}

Rgb EquiangularLights::scattered_along(const Scene& scene, const LitRay& lit, const Vec2& u,
                                       WalkContext& context) const {
    if (lights_.empty()) return Rgb(0.0f);
    const Ray& ray = lit.ray;
    const auto choice =
        choice_.sample(LightSegment{ray.origin, ray.direction, ray.t_min, lit.t_max}, double(u.x));
    const Rgb light = scattered_from(scene, lights_[choice.light], lit, u.y, context);
    if (is_black(light)) return light;
    const auto own = float(choice.probability);
    if (!std::isfinite(lit.pdf_solid_angle)) return light / own;
    // Balance heuristic: the light found counts by all densities together.
    return light * lit.pdf_solid_angle / (lit.pdf_solid_angle * own + density_around(ray, choice.light));
}

/// Density by which a vertex at the start of the ray chooses the lamp, and the direction around it [1/sr].
float EquiangularLights::density_around(const Ray& ray, std::uint32_t light) const {
    const Vec3 to_lamp = lights_[light].position - ray.origin;
    const auto chosen = float(around_.probability(LightReceiver{ray.origin}, light));
    return chosen * lights::even_angle_pdf(to_lamp, ray.direction);
}

std::optional<EquiangularLights::DirectionAroundLamp> EquiangularLights::direction_around_lamp(
    const ScatteringVertex& vertex, Rng& rng) const {
    const auto choice = around_.sample(LightReceiver{vertex.position}, double(rng.next_float()));
    const Vec2 u{rng.next_float(), rng.next_float()};
    const auto wi = lights::sample_even_angle(lights_[choice.light].position - vertex.position, u);
    if (!wi) return std::nullopt;
    return DirectionAroundLamp{choice.light, *wi};
}

/// Light along a direction around a lamp, over the densities of both techniques.
Rgb EquiangularLights::lit_around(const Scene& scene, const ScatteringVertex& vertex,
                                  const MediumState& state, const DirectionAroundLamp& direction,
                                  float pdf_of_path, WalkContext& context) const {
    const Ray ray{vertex.ray_origin(direction.wi), direction.wi};
    const Light& light = lights_[direction.light];
    if (light.cone && !lights::inside_cone(*light.cone, ray, 0.0, infinity)) return Rgb(0.0f);
    ++context.rays.closest;
    const auto hit = scene.first_hit(ray);
    const MediumState start = vertex.on_surface() ? vertex.state_towards(state, direction.wi) : state;
    Ray before = ray;
    if (hit) before.t_max = hit->t;
    context.boundary_hits.clear();
    if (scene.has_boundaries()) {
        ++context.rays.boundary;
        scene.boundaries_along(before, context.boundary_hits);
    }
    const Rgb found =
        scattered_from(scene, light, {ray, before.t_max, start}, context.rng.next_float(), context);
    if (is_black(found)) return found;
    const auto chosen = float(choice_.probability(
        LightSegment{ray.origin, ray.direction, ray.t_min, before.t_max}, direction.light));
    return found / (pdf_of_path * chosen + density_around(ray, direction.light));
}

/// Light of one lamp scattered along a ray.
Rgb EquiangularLights::scattered_from(const Scene& scene, const Light& light, const LitRay& lit, float u,
                                      WalkContext& context) const {
    const Ray& ray = lit.ray;
    Ray part = ray;
    part.t_max = lit.t_max;
    if (light.cone) {
        const auto inside = lights::inside_cone(*light.cone, ray, double(ray.t_min), double(lit.t_max));
        if (!inside) return Rgb(0.0f);
        part.t_min = float(inside->first), part.t_max = float(inside->second);
    }
    const auto distance = sample_equiangular(part, part.t_max, light.position, u);
    if (!distance) return Rgb(0.0f);

    ScatteringVertex vertex;
    vertex.position = ray.at(distance->t), vertex.wo = -ray.direction;
    const auto to_light = light.emitter->sample_direct(vertex.position, Vec2(0.5f));
    if (!to_light) return Rgb(0.0f);
    TransmittanceAlong along(ray, lit.state, context.boundary_hits, context.rng, context.tracking);
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
    return to_eye * scattered * from_light * to_light->weight / distance->pdf_distance;
}

}  // namespace mote::integrators
