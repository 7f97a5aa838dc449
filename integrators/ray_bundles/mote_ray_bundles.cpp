// `mote_ray_bundles`: light exchanged between all surfaces at once along global directions (Hermes 2010).
//
// Surfaces are an atlas of texels. Every pass exchanges radiance along the bundles of its own directions
// (gathering/radiance_exchange) and then views the atlas from the eye. The mean over passes converges to
// the picture of the atlas: biased by the size of texels, and by the long paths that the first batches of
// directions lack.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "integrators/eye_path/few_reflections.h"
#include "integrators/ray_bundles/ray_bundle_settings.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteRayBundles final : public Integrator {
  public:
    explicit MoteRayBundles(const RayBundleSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_ray_bundles"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        require(scene);
        return make_ray_bundle_estimator(scene, options, settings_);
    }

  private:
    /// Throws InputError where a pass follows too few reflections.
    void require(const Scene& scene) const {
        const gathering::ExchangeSettings& e = settings_.exchange;
        const bool interleaved = e.transfer == gathering::LightTransfer::interleaved;
        require_reflections(scene, int(interleaved ? e.directions / e.batch : e.bounces), type(),
                            fmt::format("more {} follow more; path and mote_bdpt follow them all",
                                        interleaved ? "directions" : "bounces"));
    }
    void plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const;
    RayBundleSettings settings_;
};

Plan MoteRayBundles::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    const gathering::ExchangeSettings& e = settings_.exchange;
    const bool interleaved = e.transfer == gathering::LightTransfer::interleaved;
    plan.run("surfaces",
             settings_.atlas.texels_per_metre > 0.0f
                 ? fmt::format("an atlas of {:.4g} texels per metre", settings_.atlas.texels_per_metre)
                 : fmt::format("an atlas of {} texels at most", settings_.atlas.texel_budget),
             "light is even over a texel: details of light and shadow smaller than that are blurred");
    plan.run("directions", fmt::format("{} a pass, exchanged after every {}", e.directions, e.batch),
             "fresh ones every pass; a direction serves all surfaces and both ways");
    plan.run(
        "bounces", interleaved ? "all at once" : fmt::format("one at a time, {} of them", e.bounces),
        interleaved
            ? fmt::format("what a batch of directions received is sent by the next: light of more than {} "
                          "reflections is missing",
                          e.directions / e.batch)
            : "transfer is 'one_bounce'");
    const bool hit = r.lights_area + r.lights_infinite > 0;
    if (hit)
        plan.run("area lights and environment", e.lights ? "by bundles" : "sampled at texels and pixels",
                 e.lights ? "direct is 'bundles'" : "direct is 'lights'");
    if (r.lights_point > 0)
        plan.run("lights with a position", fmt::format("{} samples a texel, one a pixel", light_samples),
                 "no ray of a bundle meets them");
    plan.run("view", "the atlas", "on diffuse surfaces; paths scatter on from all others");
    plan_choice_of_lights(plan, scene);
    plan_missing(plan, scene, r);
    try {
        require(scene);
    } catch (const InputError& error) {
        plan.miss("the whole picture", "refused", error.what());
    }
    return plan;
}

void MoteRayBundles::plan_missing(Plan& plan, const Scene& scene, const Requirements& r) const {
    if (r.any_media())
        plan.miss("media", "left out",
                  "links between surfaces and eye paths go through them as through vacuum");
    if (r.any_delta())
        plan.miss("mirrors and glass", "black in the exchange",
                  "light that they pass on between surfaces is missing; eye paths follow them");
    if (scene.has_panes())
        plan.miss("panes and masks", "left out of the exchange",
                  "links pass them unhindered, and what they reflect to other surfaces is missing");
    const bool interleaved = settings_.exchange.transfer == gathering::LightTransfer::interleaved;
    if (r.any_glossy() && !(settings_.exchange.glossy && interleaved))
        plan.miss("glossy surfaces", "reflect towards the eye alone",
                  interleaved ? "glossy_transfer is false" : "transfer is 'one_bounce'");
    if (!interleaved)
        plan.miss("long paths", fmt::format("light of more than {} reflections", settings_.exchange.bounces),
                  "transfer is 'one_bounce'");
}

}  // namespace

void register_mote_ray_bundles(Registry& registry) {
    add_type(
        registry, Category::integrator, "mote_ray_bundles",
        "Global ray-bundles: light is exchanged between all surfaces along parallel rays, and seen as an "
        "atlas holds it. For diffuse surfaces without media.",
        ray_bundle_parameters(),
        R"(<integrator type="mote_ray_bundles"><integer name="directions" value="512"/></integrator>)",
        [](const RayBundleSettings& s) { return std::make_shared<MoteRayBundles>(s); });
}

}  // namespace mote::integrators
