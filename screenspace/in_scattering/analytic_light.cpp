#include "screenspace/in_scattering/analytic_light.h"

#include <algorithm>

namespace mote::screenspace {

using namespace core;

namespace {
/// Smallest beam, as a fraction of the cone, whose rim is smooth enough for eight points a panel.
constexpr double smallest_beam = 0.25;
}  // namespace

std::optional<AnalyticMedium> AnalyticMedium::of(const Medium& medium) {
    const MediumTraits traits = medium.traits();
    if (!traits.homogeneous) return std::nullopt;
    const auto g = medium.phase().henyey_greenstein();
    if (!g) return std::nullopt;
    const MediumCoefficients c = medium.coefficients(Vec3(0.0f));
    return AnalyticMedium{&medium, c.sigma_t, c.sigma_s, *g};
}

Rgb AnalyticMedium::transmittance(double length) const {
    Rgb result(1.0f);
    for (int c = 0; c < 3; ++c)
        if (sigma_t[c] > 0.0f) result[c] = float(std::exp(-double(sigma_t[c]) * length));
    return result;
}

std::optional<AnalyticLight> AnalyticLight::of(const Emitter& light) {
    const auto position = LitScene::light_position(light);
    if (!position || light.traits().textured) return std::nullopt;
    AnalyticLight result(light, *position);
    Vec3 axis(0, 0, 1);
    if (const auto* spot = dynamic_cast<const lights::ConeLight*>(&light)) {
        lights::LightCone cone = spot->cone();
        if (cone.angle >= 0.5 * double(pi) || !(cone.beam >= smallest_beam * cone.angle)) return std::nullopt;
        axis = cone.axis;
        result.has_rim_ = cone.beam < cone.angle;
        cone.angle = cone.beam, result.beam_ = cone;
    } else if (light.traits().kind != EmitterKind::point) {
        return std::nullopt;
    }
    const float away = 1.0f + glm::length(*position);
    const auto sample = light.sample_direct(*position + away * axis, Vec2(0.5f));
    if (!sample) return std::nullopt;
    result.intensity_ = sample->weight * sqr(sample->distance);
    return result;
}

Rgb AnalyticLight::piece(const Ray& ray, const PassingRay& passing, double t0, double t1,
                         const AnalyticMedium& medium, bool rim) const {
    const float full = max_component(intensity_);
    const auto fall_off = [&](double t) {
        const auto sample =
            light_.sample_direct(Vec3(Vec3d(ray.origin) + t * Vec3d(ray.direction)), Vec2(0.5f));
        return sample ? double(max_component(sample->weight)) * sqr(double(sample->distance)) / double(full)
                      : 0.0;
    };
    Rgb result(0.0f);
    for (int c = 0; c < 3; ++c) {
        const double sigma_t = double(medium.sigma_t[c]), g = double(medium.g);
        if (c > 0 && medium.sigma_t[c] == medium.sigma_t[c - 1]) {
            result[c] = result[c - 1];
            continue;
        }
        result[c] = float(rim ? airlight(passing, t0, t1, sigma_t, g, fall_off)
                              : airlight(passing, t0, t1, sigma_t, g));
    }
    return result;
}

Rgb AnalyticLight::in_scattered(const Ray& ray, double t0, double t1, const AnalyticMedium& medium) const {
    const PassingRay passing(ray, position_);
    Rgb sum(0.0f);
    double at = t0;
    const auto add = [&](double to, bool rim) {
        if (!(at < to)) return;
        sum += medium.transmittance(at - t0) * piece(ray, passing, at, to, medium, rim);
        at = to;
    };
    if (has_rim_) {
        const auto beam = lights::inside_cone(beam_, ray, t0, t1);
        if (beam) add(beam->first, true), add(beam->second, false);
        add(t1, true);
    } else {
        add(t1, false);
    }
    return medium.sigma_s * intensity_ * sum;
}

}  // namespace mote::screenspace
