#include "integrators/single_scattering/scattering_accelerations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "integrators/single_scattering/single_scattering_estimator.h"
#include "lights/visibility/mapped_visibility.h"

namespace mote::integrators {

using namespace core;
using screenspace::AnalyticLight, screenspace::AnalyticMedium;

namespace {

/// Building a texel takes as long as a map saves on so many steps (docs/methods/epipolar.md).
constexpr double steps_per_texel = 8.0;

/// Lights and media whose in-scattering can be integrated, and all that scatter.
struct AnalyticCounts {
    std::size_t lights = 0, all_lights = 0, media = 0, all_media = 0;

    explicit AnalyticCounts(const Scene& scene) {
        for (const Emitter* light : positional_lights(scene))
            ++all_lights, lights += AnalyticLight::of(*light).has_value();
        for (const auto& medium : scene.media()) {
            const MediumTraits traits = medium->traits();
            if (!traits.scattering || traits.empty) continue;
            ++all_media, media += AnalyticMedium::of(*medium).has_value();
        }
    }
    bool any() const { return lights > 0 && media > 0; }
};

void plan_exact(Plan& plan, const AnalyticCounts& analytic, const AccelerationSettings& settings, int steps) {
    if (!settings.exact) {
        plan.leave_out("exact in-scattering", "all rays are marched", "in_scattering is not exact");
        return;
    }
    if (!analytic.any()) {
        plan.leave_out("exact in-scattering", "all rays are marched",
                       analytic.media == 0 ? "no medium that scatters is homogeneous"
                                           : "every light is textured, or no cone with a narrow rim");
        return;
    }
    plan.run(
        "exact in-scattering",
        fmt::format("{} of {} lights, {} of {} media", analytic.lights, analytic.all_lights, analytic.media,
                    analytic.all_media),
        "where one homogeneous medium lies between light and ray; no steps and no shadow rays where nothing "
        "is in the way");
    if (settings.light_maps)
        plan.run("behind occluders", fmt::format("{} steps a ray", steps), "looked up in shadow maps");
    else
        plan.run("behind occluders", fmt::format("{} shadow rays a ray", steps),
                 "they show which parts are lit; these are integrated");
    if (analytic.lights < analytic.all_lights)
        plan.run("marched lights",
                 fmt::format("{} of {}", analytic.all_lights - analytic.lights, analytic.all_lights),
                 "their intensity varies: a texture, or a cone that is mostly rim or wider than 90 degrees");
}

void plan_maps(Plan& plan, const Scene& scene, const AccelerationSettings& settings, int steps) {
    if (!settings.light_maps) {
        plan.run("visibility", "shadow rays", "exact");
        return;
    }
    const lights::LightMapSettings& s = *settings.light_maps;
    std::size_t count = 0;
    for (const auto& light : scene.emitters())
        count += lights::shadow_map_view_of(scene, *light, 1).has_value();
    if (s.size == 0 || count == 0) {
        plan.run("visibility", "shadow rays",
                 s.size == 0 ? "light_size is 0" : "no light is a point, a cone or parallel");
        return;
    }
    const std::size_t bytes = s.map.bytes(s.size, lights::needs_chromatic_maps(scene));
    const double texels = double(s.size) * double(s.size);
    const double pixels = double(scene.film().width) * double(scene.film().height);
    plan.run("visibility",
             fmt::format("{} shadow map{} of {}^2 texels, {:.1f} MB each, built once", count,
                         count == 1 ? "" : "s", s.size, double(bytes) * 1e-6),
             "requested, biased; at march steps alone: surfaces are traced");
    plan.run("cost of shadow maps",
             fmt::format("{:.0f} texels a light, against up to {:.0f} steps a pass", texels, pixels * steps),
             pixels * steps > steps_per_texel * texels
                 ? "they pay if most rays are marched"
                 : fmt::format("tracing is cheaper for {:.0f} passes",
                               std::ceil(steps_per_texel * texels / (pixels * steps))));
    plan.miss("detail of shadows", "finer than the texels of shadow maps",
              "maps interpolate: shafts are blurred, and the mean is biased");
}

}  // namespace

ScatteringAccelerations::ScatteringAccelerations(const Scene& scene, const AccelerationSettings& settings,
                                                 const MemoryBudget& memory) {
    if (settings.exact && AnalyticCounts(scene).any()) space_.emplace(scene.shapes());
    if (!settings.light_maps || !scene.has_media() || settings.light_maps->size == 0) return;
    const lights::LightMapSettings& s = *settings.light_maps;
    lights::check_map(scene, s, s.size);
    maps_.emplace(scene, s.size, s.map, memory);
}

void ScatteringAccelerations::add_statistics(Statistics& statistics) const {
    if (space_) statistics.values["unoccluded_space_bytes"] = double(space_->memory_bytes());
    if (!maps_) return;
    const RayCounters rays = maps_->rays();
    statistics.rays["closest"] += rays.closest;
    statistics.rays["occlusion"] += rays.occlusion;
    statistics.rays["boundary"] += rays.boundary;
    statistics.values["shadow_maps"] = double(maps_->count());
    statistics.values["shadow_map_bytes"] = double(maps_->memory_bytes());
}

void plan_scattering_accelerations(Plan& plan, const Scene& scene, const AccelerationSettings& settings,
                                   int steps) {
    const AnalyticCounts analytic(scene);
    if (analytic.all_lights > 0) plan_exact(plan, analytic, settings, steps);
    plan_maps(plan, scene, settings, steps);
}

}  // namespace mote::integrators
