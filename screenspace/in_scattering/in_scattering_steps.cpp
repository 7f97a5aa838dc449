// In-scattering by steps: where they are, what each scatters, and their sum along the media of a ray.
#include <algorithm>

#include "screenspace/in_scattering/in_scattering.h"

namespace mote::screenspace {

using namespace core;

double StepRule::at(double fraction) const {
    if (fraction <= 0.0) return t0;
    if (fraction >= 1.0) return t1;
    if (rule == MarchRule::uniform) return t0 + fraction * (t1 - t0);
    return std::clamp(passing.at_angle(a0 + fraction * (a1 - a0)), t0, t1);
}

double StepRule::length(double t) const {
    if (rule == MarchRule::uniform) return t1 - t0;
    const double s = t - passing.nearest;
    return (a1 - a0) * (passing.distance + s * s / passing.distance);
}

void InScattering::place_steps(const StepRule& rule, std::vector<float>& distances) const {
    distances.clear();
    for (int i = 0; i < settings_.steps; ++i)
        distances.push_back(float(rule.at((i + double(settings_.offset)) / settings_.steps)));
}

/// L_M^d, the integrand of Engelhardt 2013, Eq. 10.7: sigma_s f_p T V I / d^2 at one point [1/m times
/// radiance].
Rgb InScattering::scattered_at(const Ray& ray, float t, const MediumSegment& at, MarchScratch& scratch,
                               const Rgb* from_map) const {
    const Vec3 x = ray.at(t);
    const auto light = light_.sample_direct(x, Vec2(0.5f));
    if (!light) return Rgb(0.0f);
    ++scratch.walk.tracking.lookups;
    const Rgb sigma_s = at.medium->coefficients(x).sigma_s;
    if (is_black(sigma_s)) return Rgb(0.0f);
    Rgb to_light;
    if (from_map) {
        to_light = *from_map;
    } else {
        const Ray shadow{x, light->wi, 0.0f, light->distance};
        ++scratch.walk.rays.occlusion;
        if (!scene_.visible(shadow)) return Rgb(0.0f);
        find_segments(scene_, shadow, at.state, scratch.shadow, scratch.walk);
        to_light = marched_transmittance(shadow, scratch.shadow, settings_.voxels, scratch.walk);
    }
    return sigma_s * at.medium->phase().eval(-ray.direction, light->wi) * to_light * light->weight;
}

/// From the light to every step, by its map.
void InScattering::look_up_steps(const Ray& ray, MarchScratch& scratch) const {
    constexpr std::size_t width = lights::ShadowLookup::width;
    const std::size_t steps = scratch.distances.size();
    scratch.lookups.resize((steps + width - 1) / width);
    for (std::size_t i = 0; i < scratch.lookups.size() * width; ++i) {
        const Vec3 x = ray.at(scratch.distances[std::min(i, steps - 1)]);
        lights::ShadowLookup& p = scratch.lookups[i / width];
        p.x[i % width] = x.x, p.y[i % width] = x.y, p.z[i % width] = x.z;
    }
    accelerations_.map->look_up(scratch.lookups);
}

void InScattering::march_steps(const Ray& ray, double t0, double t1, MarchScratch& scratch,
                               MarchedRay& result) const {
    scratch.distances.clear();
    const StepRule rule(settings_.rule, ray, position_, t0, t1);
    if (t0 < t1 && (std::isfinite(t1) || settings_.rule == MarchRule::equiangular))
        place_steps(rule, scratch.distances);
    if (accelerations_.map && !scratch.distances.empty()) look_up_steps(ray, scratch);

    std::size_t next = 0;
    for (const MediumSegment& s : scratch.eye) {
        float t = s.t0;
        result.transmittance *= s.panes;
        const auto advance = [&](float to) {
            if (s.medium && t < to)
                result.transmittance *= marched_transmittance(*s.medium, {ray.origin, ray.direction, t, to},
                                                              settings_.voxels, scratch.walk);
            t = std::max(t, to);
        };
        for (; next < scratch.distances.size() && scratch.distances[next] <= s.t1; ++next) {
            const float at = scratch.distances[next];
            advance(at);
            if (!s.medium) continue;
            ++scratch.steps;
            Rgb from_map;
            if (accelerations_.map) {
                const lights::ShadowLookup& p = scratch.lookups[next / lights::ShadowLookup::width];
                const std::size_t lane = next % lights::ShadowLookup::width;
                from_map = Rgb(p.r[lane], p.g[lane], p.b[lane]);
            }
            const Rgb scattered = scattered_at(ray, at, s, scratch, accelerations_.map ? &from_map : nullptr);
            if (!is_black(scattered))
                result.radiance +=  // the first integral of Eq. 10.7
                    result.transmittance * scattered * float(rule.length(double(at)) / settings_.steps);
        }
        advance(s.t1);
    }
}

}  // namespace mote::screenspace
