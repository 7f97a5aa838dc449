// Settings, layers and plan entries that `mote_single_scattering` and `mote_epipolar` share.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/parameters/nested.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_coarse_voxels.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

ParameterList<ScatteringSettings> scattering_parameters() {
    using S = ScatteringSettings;
    using screenspace::MarchSettings;
    return {
        within(&S::march,
               row("steps", &MarchSettings::steps, between(1, 1 << 20),
                   "steps of every marched ray, or places that exact integrals are traced from: time grows "
                   "with it, the error of shafts falls with it")),
        row("in_scattering", &S::in_scattering,
            {{"exact", AlongRay::exact},
             {"steps", AlongRay::steps},
             {"uniform_steps", AlongRay::uniform_steps}},
            "exact: integrals where one homogeneous medium lies between ray and light, without shadow rays "
            "where nothing else does, and steps elsewhere; steps: all rays are marched, in equal angles as "
            "seen from the light; uniform_steps: in equal lengths, as in the paper"),
        nested("visibility", &S::visibility, Category::visibility, "traced",
               "occlusion between light and march steps: traced, or shadow_map with its light_size, which "
               "takes half the time a step and is biased by a texel"),
        within(
            &S::march,
            row("voxels", &MarchSettings::voxels, between(1e-3, 1e6, "voxels"),
                "step of optical depths through grids: larger ones take less time and bias transmittance")),
        row("show_samples", &S::show_samples,
            "adds a layer MarchedRays: rays marched in every pixel, a pass"),
        row("lights", &S::lights,
            {{"all", ScatteringLights::all},
             {"positional", ScatteringLights::positional},
             {"other", ScatteringLights::other}},
            "lights whose light scatters in media: all, positional (those that are marched), or other (all "
            "but those); a nested integrator of mote_layers may do either"),
        row("max_depth", &S::rays, between(1, 1 << 20),
            "longest eye path through mirrors and glass, in rays: light behind more of them is missing"),
        within(&S::eye, within(&EyeSettings::limits, eye_path_rows().without({"max_depth", "rr_depth"})))};
}

ScatteringSettings scattering_settings(const EyePathLimits& limits, ScatteringLights lights) {
    ScatteringSettings settings;
    if (limits.max_depth > 1) settings.rays = limits.max_depth - 1;
    settings.eye.limits.hide_emitters = limits.hide_emitters, settings.lights = lights;
    return settings;
}

std::vector<Layer> single_scattering_layers(bool media, const ScatteringSettings& settings) {
    std::vector<Layer> layers = {transport_layer_of(Transport::emission),
                                 transport_layer_of(Transport::direct)};
    if (media) layers.push_back(transport_layer_of(scattering_cell(settings.lights)));
    if (media && settings.show_samples) layers.push_back({"MarchedRays", "rays marched in the pixel", true});
    return layers;
}

std::vector<const Emitter*> positional_lights(const Scene& scene) {
    std::vector<const Emitter*> lights;
    for (const auto& light : scene.emitters())
        if (Scene::light_position(*light) && !is_black(light->power())) lights.push_back(light.get());
    return lights;
}

bool has_other_lights(const Scene& scene) {
    bool other = false;
    for (const auto& light : scene.emitters()) other |= !light->traits().delta_position;
    for (const auto& medium : scene.media()) other |= medium->traits().emissive;
    return other;
}

namespace {

/// Rays that a pass marches for one light, at least.
double rays_of_light(const Scene& scene, const ScatteringSettings& s) {
    const double pixels = double(scene.film().width) * double(scene.film().height);
    return s.sampling == ScatteringSampling::full       ? pixels
           : s.sampling == ScatteringSampling::epipolar ? double(s.lines) * s.line.initial
                                                        : pixels / sqr(double(s.spacing));
}

}  // namespace

void require_few_lights(const Scene& scene, const ScatteringSettings& s, std::size_t lights) {
    constexpr std::size_t many = 1000;
    constexpr double max_rays = 5e7;  ///< ten minutes of one processor
    const double of_light = rays_of_light(scene, s);
    if (lights > many && double(lights) * of_light > max_rays)
        throw InputError(fmt::format(
            "{} lights with a position are too many to be marched: {:.0f} million rays a pass, {:.0f} for "
            "each; volpath and mote_layers sample one light a ray",
            lights, 1e-6 * double(lights) * of_light, of_light));
}

namespace {

/// Every light is marched in every pass, whatever it adds: a pass of thousands takes minutes and more.
void warn_of_many_lights(Plan& plan, const Scene& scene, const ScatteringSettings& s, std::size_t lights) {
    constexpr double patience = 1e7;  ///< rays: two minutes of one processor
    const double of_light = rays_of_light(scene, s);
    constexpr std::size_t few = 16;
    if (lights <= few || double(lights) * of_light < patience) return;
    plan.costly.push_back(
        fmt::format("every pass marches at least {:.0f} million rays, {:.0f} for each of {} lights, and "
                    "shows no pixel before; "
                    "volpath and mote_layers sample one light a ray",
                    1e-6 * double(lights) * of_light, of_light, lights));
}

}  // namespace

void plan_single_scattering(Plan& plan, const Scene& scene, const Requirements& r,
                            const ScatteringSettings& s) {
    plan.run(
        "surfaces", "one eye path per pixel and pass",
        "direct light at full rate: of each light with a position where they are few, and of one that is "
        "sampled, by two techniques");
    if (r.cells[Transport::indirect] || r.cells[Transport::multiple_scattering])
        plan.miss("light scattered more than once", "indirect light and multiple scattering",
                  "this integrator stops after one scattering; volpath renders the rest");
    plan_choice_of_lights(plan, scene);
    plan_caustics(plan, scene, r);
    if (!r.any_media()) {
        plan_media(plan, r);
        return;
    }
    for (std::size_t i = 0; i < r.media_descriptions.size(); ++i)
        plan.run("medium", r.media_descriptions[i], "in the scene");
    if (r.media_heterogeneous > 0)
        plan.run("transmittance", fmt::format("marched in steps of {} voxels", s.march.voxels),
                 "deterministic, so that neighbouring rays can be interpolated; biased by the step");
    plan_coarse_voxels(plan, scene, s.march.voxels);
    plan_narrow_phases(plan, scene);
    if (!r.media_scattering) {
        plan.leave_out("single scattering", "nothing is marched", "no medium scatters");
        return;
    }
    const std::size_t lights = s.lights == ScatteringLights::other ? 0 : positional_lights(scene).size();
    if (s.lights == ScatteringLights::other)
        plan.leave_out("marching", "no ray is marched", "lights is 'other'");
    else if (lights > 0) {
        plan.run(
            "marching",
            fmt::format("{} steps a ray, {}", s.march.steps,
                        s.in_scattering == AlongRay::uniform_steps ? "of equal lengths" : "of equal angles"),
            fmt::format("{} light{} with a position", lights, lights == 1 ? "" : "s"));
        warn_of_many_lights(plan, scene, s, lights);
    } else
        plan.leave_out("marching", "no ray is marched", "no light has a position");
    plan_scattering_accelerations(plan, scene, s.accelerations(), s.march.steps);
    if (s.lights != ScatteringLights::positional && has_other_lights(scene))
        plan.run("other lights and emission of media",
                 "one sampled distance per pixel and pass, at full rate", "they have no position");
}

}  // namespace mote::integrators
