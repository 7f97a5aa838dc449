// `mote_micro_rendering`: final gathering from points (Engelhardt 2013, Ch. 8; Ritschel et al. 2009), on
// surfaces.
//
// Every pass spreads points over all surfaces and stores at each the light that it reflects. At what the eye
// sees a micro-buffer, an image of a few texels over the hemisphere, holds the points that are visible; the
// receiver reflects their light. Direct light is computed apart. Biased: light is even over the disc of a
// point, and over a texel.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "integrators/eye_path/few_reflections.h"
#include "integrators/micro_rendering/micro_settings.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;
using gathering::StoredLight;
namespace {

class MoteMicroRendering final : public Integrator {
  public:
    explicit MoteMicroRendering(const MicroSettings& settings) : settings_(settings) {
        settings_.limit_bounces();
    }

    std::string type() const override { return "mote_micro_rendering"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        check(scene);
        return make_micro_estimator(scene, options, settings_);
    }

  private:
    /// Throws InputError for scenes that this method cannot render.
    void check(const Scene& scene) const;
    void plan_light(Plan& plan) const;
    void plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const;
    MicroSettings settings_;
};

void MoteMicroRendering::check(const Scene& scene) const {
    settings_.check(scene.has_media());
    const int bounces = settings_.points.bounces, wanted = settings_.max_bounces();
    if (settings_.points.light == StoredLight::radiosity && (wanted < 0 || wanted > bounces))
        require_reflections(scene, bounces, type(),
                            "light = 'photons' or 'vpls' follows them all, as do path and mote_bdpt");
}

void MoteMicroRendering::plan_light(Plan& plan) const {
    const gathering::LitPointSettings& p = settings_.points;
    plan.run("light of points", "four sampled lights each", "what they reflect is gathered");
    switch (p.light) {
        case StoredLight::direct:
            plan.miss("light of more bounces", "two reflections and more before what the eye sees",
                      "light is 'direct'");
            break;
        case StoredLight::vpls:
            plan.run("further bounces", fmt::format("virtual point lights of {} light paths", p.paths.paths),
                     "light is 'vpls'");
            if (!settings_.bound || *settings_.bound > 0.0f)
                plan.miss("short distances", "between virtual point lights and points light is darkened",
                          "it is bounded; bound = 0 takes the bound away");
            break;
        case StoredLight::radiosity:
            plan.run("further bounces", fmt::format("{}, exchanged between points", p.bounces),
                     "one of 64 points gathers for all of them");
            plan.miss("long paths", fmt::format("light of more than {} reflections before", p.bounces),
                      "light is 'radiosity'");
            break;
        case StoredLight::photons:
            plan.run("further bounces", fmt::format("the density of photons of {} paths", p.paths.paths),
                     "light is 'photons'");
            break;
    }
}

void MoteMicroRendering::plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const {
    if (!settings_.buffers.cast_leaves)
        plan.miss("surfaces close by", "points fill one texel, which leaves holes", "ray_casting is false");
    if (r.any_delta())
        plan.miss(
            "mirrors and glass", "black where points are gathered",
            settings_.points.light == StoredLight::photons
                ? "light that they pass on to other surfaces is in the photons, to receivers it is missing"
                : "light that they pass on to other surfaces is missing; eye paths follow them");
    if (r.any_glossy())
        plan.miss("glossy surfaces", "reflect to others like diffuse ones", "points send one radiance");
    if (scene.has_panes())
        plan.miss("panes and masks", "left out of what is gathered",
                  "buffers look through them unhindered, and what they reflect to other surfaces is missing");
    if (settings_.upsampling > 1)
        plan.run(
            "upsampling",
            fmt::format("receivers at one pixel of {0} x {0}, another one in every pass",
                        settings_.upsampling),
            "biased: light is blurred between them; pixels without similar neighbours are rendered again");
}

Plan MoteMicroRendering::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    const gathering::LitPointSettings& p = settings_.points;
    plan.run("points", fmt::format("{} a pass", p.points), "a fresh set every pass");
    plan.run("micro-buffers", fmt::format("{0} x {0} texels", settings_.buffers.side),
             "biased: light is even over a point and over a texel, less with more of both");
    plan_light(plan);
    plan_missing(plan, scene, r);
    plan_choice_of_lights(plan, scene);
    if (!r.any_media()) plan.leave_out("media", "no code for media runs", "the scene has none");
    try {
        check(scene);
    } catch (const InputError& error) {
        plan.miss("the whole picture", "refused", error.what());
    }
    return plan;
}

}  // namespace

void register_mote_micro_rendering(Registry& registry) {
    add_type(
        registry, Category::integrator, "mote_micro_rendering",
        "Final gathering from points, for scenes without media: what the eye sees gathers the light of "
        "points on all surfaces with micro-buffers (Ritschel et al. 2009). Biased by the size of points and "
        "texels.",
        micro_parameters(),
        R"(<integrator type="mote_micro_rendering"><integer name="points" value="100000"/></integrator>)",
        [](const MicroSettings& s) { return std::make_shared<MoteMicroRendering>(s); });
}

}  // namespace mote::integrators
