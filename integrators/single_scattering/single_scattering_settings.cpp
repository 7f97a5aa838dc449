// Settings, layers and plan entries that `mote_single_scattering` and `mote_epipolar` share.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

ScatteringSettings read_scattering_settings(const Properties& p) {
    ScatteringSettings s;
    s.march.steps = int(p.get_int_in("steps", 64, 1, 1 << 20));
    const std::string how = p.get_choice("in_scattering", "exact", {"exact", "steps", "uniform_steps"});
    s.accelerations.exact = how == "exact";
    s.march.rule =
        how == "uniform_steps" ? screenspace::MarchRule::uniform : screenspace::MarchRule::equiangular;
    if (const auto visibility = p.child_of<Visibility>(Category::visibility))
        s.accelerations.visibility = visibility->settings();
    s.march.voxels = float(p.get_float_in("voxels", 1.0, 1e-3, 1e6));
    s.eye.limits.max_depth = 1 + int(p.get_int_in("max_depth", 32, 1, 1 << 20));
    s.eye.limits.hide_emitters = p.get_bool("hide_emitters", false);
    s.show_samples = p.get_bool("show_samples", false);
    const std::string lights = p.get_choice("lights", "all", {"all", "positional", "other"});
    s.lights = lights == "positional" ? ScatteringLights::positional
               : lights == "other"    ? ScatteringLights::other
                                      : ScatteringLights::all;
    return s;
}

Properties scattering_properties(const EyePathLimits& limits, const std::string& lights) {
    Properties properties;
    if (limits.max_depth > 1) properties.values["max_depth"] = {std::int64_t(limits.max_depth - 1), {}};
    properties.values["hide_emitters"] = {limits.hide_emitters, {}};
    properties.values["lights"] = {lights, {}};
    return properties;
}

std::vector<Parameter> scattering_parameters() {
    return {
        {"steps", "integer", "64",
         "steps of every marched ray, or places that exact integrals are traced from"},
        {"in_scattering", "string", "exact",
         "exact: integrals where one homogeneous medium lies between ray and light, without shadow rays "
         "where nothing else does, and steps elsewhere; steps: all rays are marched, in equal angles as seen "
         "from the light; uniform_steps: in equal lengths, as in the paper"},
        {"visibility", "visibility", "traced",
         "what stands between light and march steps: traced, or shadow_map with its light_size"},
        {"voxels", "float", "1", "step of optical depths through grids, in voxels"},
        {"show_samples", "boolean", "false", "adds a layer MarchedRays: rays marched in every pixel, a pass"},
        {"lights", "string", "all",
         "whose light scatters in media: all, positional (those that are marched), or other (all but those); "
         "a nested integrator of mote_layers may do either"},
        {"max_depth", "integer", "32", "longest eye path through mirrors and glass, in rays"},
        hide_emitters_parameter()};
}

std::vector<Layer> single_scattering_layers(bool media, const ScatteringSettings& settings) {
    std::vector<Layer> layers = {{"emission", "light sources seen directly or through mirrors and glass"},
                                 {"direct", "light scattered once, on a surface"}};
    if (media) {
        layers.push_back({transport_name(Transport::single_scattering), "light scattered once, in a medium"});
        if (settings.lights == ScatteringLights::positional)
            layers.back().name = layers.back().cell = positional_scattering;
        if (settings.lights == ScatteringLights::other)
            layers.back().name = layers.back().cell = other_scattering;
    }
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

void plan_single_scattering(Plan& plan, const Scene& scene, const Requirements& r,
                            const ScatteringSettings& s) {
    plan.run(
        "surfaces", "one eye path per pixel and pass",
        "direct light at full rate: of each light with a position where they are few, and of one that is "
        "drawn, by two techniques");
    if (r.wants("indirect") || r.wants("multiple_scattering"))
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
    if (!r.media_scattering) {
        plan.leave_out("single scattering", "nothing is marched", "no medium scatters");
        return;
    }
    const std::size_t lights = s.lights == ScatteringLights::other ? 0 : positional_lights(scene).size();
    if (s.lights == ScatteringLights::other)
        plan.leave_out("marching", "no ray is marched", "lights is 'other'");
    else if (lights > 0)
        plan.run("marching",
                 fmt::format("{} steps a ray, {}", s.march.steps,
                             s.march.rule == screenspace::MarchRule::uniform ? "of equal lengths"
                                                                             : "of equal angles"),
                 fmt::format("{} light{} with a position", lights, lights == 1 ? "" : "s"));
    else
        plan.leave_out("marching", "no ray is marched", "no light has a position");
    plan_scattering_accelerations(plan, scene, s.accelerations, s.march.steps);
    if (s.lights != ScatteringLights::positional && has_other_lights(scene))
        plan.run("other lights and emission of media",
                 "one sampled distance per pixel and pass, at full rate", "they have no position");
}

}  // namespace mote::integrators
