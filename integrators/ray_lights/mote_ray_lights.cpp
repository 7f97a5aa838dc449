// `mote_ray_lights`: virtual ray lights in media (Novak et al. 2012), virtual point lights on surfaces.
//
// Every pass traces a fresh set of light paths. Their segments in media are lights all along, and eye rays
// gather them all along: there is no point from which 1/d^2 could blow up, so that nothing has to be bounded
// or brought back in media. Surfaces keep VPLs, bounded, and what the bound takes is found by eye paths that
// continue (ray_light_tile.h). So the mean is right, but for light that passes mirrors and glass last.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/ray_lights/plan_thick_cells.h"
#include "integrators/ray_lights/ray_light_settings.h"
#include "integrators/register_parts.h"
#include "lights/ray_lights/ray_light.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteRayLights final : public Integrator {
  public:
    explicit MoteRayLights(const RayLightSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_ray_lights"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return transport_layers(scene.has_media());
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_ray_light_estimator(scene, options, settings_);
    }

  private:
    void plan_lines(Plan& plan) const;
    RayLightSettings settings_;
};

void MoteRayLights::plan_lines(Plan& plan) const {
    plan.run("ray lights",
             fmt::format("segments of light paths in media, {} bytes each", sizeof(lights::RayLight)),
             "light scatters all along them; VPLs stand on surfaces alone");
    plan.run("eye rays",
             settings_.connections > 0
                 ? fmt::format("{} connections each, sampled by importance", settings_.connections)
                 : "all ray lights and VPLs each",
             "a point on the ray light by the asinh of its distance, then one on the eye ray equi-angularly");
    plan.run("single scattering", fmt::format("{} scattering points a ray", settings_.scattering_points),
             "light of lights is not that of virtual ones");
}

Plan MoteRayLights::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.run("light paths", fmt::format("{} a pass", settings_.paths), "a fresh set every pass");
    plan_media(plan, r);
    plan_narrow_phases(plan, scene);
    plan_thick_cells(plan, scene);
    if (r.media_scattering)
        plan_lines(plan);
    else
        plan.leave_out("ray lights", "light paths leave VPLs on surfaces alone", "no medium scatters");
    const float bound = settings_.bound_for(scene.rays().bounds());
    plan.run(
        "bound", fmt::format("{:.4g} /m^2, from surface to surface", bound),
        settings_.bound ? "requested" : "automatic: by the light paths that a receiver gathers, over R^2");
    plan.run("compensation", "exact: eye paths continue to what is nearer than the bound",
             "nothing is bounded along eye rays");
    if (r.any_delta())
        plan.miss("caustics", "light that reaches a receiver through a delta surface",
                  "a virtual light cannot be connected through mirrors and glass; volpath renders it");
    plan_choice_of_lights(plan, scene);
    plan_medium_lights(plan, r);
    return plan;
}

}  // namespace

void register_mote_ray_lights(Registry& registry) {
    using S = RayLightSettings;
    add_type<S>(
        registry, Category::integrator, "mote_ray_lights",
        "Virtual ray lights in media and virtual point lights on surfaces (Novak et al. 2012): unbiased.",
        {within(&S::eye, eye_path_rows()),
         row("paths", &S::paths, between(0, 1 << 26), "Light paths traced in every pass."),
         row("connections", &S::connections, between(0, 1 << 26),
             "Connections of a segment of an eye path to ray lights and VPLs, sampled by importance: more "
             "take time in proportion, and lower the noise that is not of light paths; 0: to all."),
         row("candidates", &S::candidates, between(0, 1 << 26),
             "Ray lights, and as many VPLs, whose importance a tile of 4 x 4 pixels evaluates, sampled by "
             "power; 0: all of them."),
         row("bound", &S::bound, between(0, 1e30, "1/m^2"),
             "Bound b on the geometry term from surface to surface; eye paths that continue find what is "
             "above it. automatic: light paths that a receiver is connected to, at least 16, over R^2."),
         row("scattering_points", &S::scattering_points, between(1, 64),
             "Points in media where each eye ray samples lights: less noise of single scattering for more "
             "shadow rays.")},
        R"(<integrator type="mote_ray_lights"><integer name="paths" value="128"/></integrator>)",
        [](const S& s) { return std::make_shared<MoteRayLights>(s); });
}

}  // namespace mote::integrators
