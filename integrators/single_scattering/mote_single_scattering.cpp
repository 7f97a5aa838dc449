// `mote_single_scattering`: light scattered at most once, by ray marching.
//
// At full rate it is the reference of `mote_epipolar`; sub-sampled, with bilateral upsampling, its rival.
#include <fmt/format.h>

#include "core/parameters/add_type.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteSingleScattering final : public Integrator {
  public:
    explicit MoteSingleScattering(ScatteringSettings settings) : settings_(std::move(settings)) {}

    std::string type() const override { return "mote_single_scattering"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return single_scattering_layers(scene.has_media(), settings_);
    }
    Plan plan(const Scene& scene, const Requirements& r) const override {
        Plan plan;
        plan.integrator = type();
        // But for the step of marching, whose bias is small.
        if (settings_.sampling == ScatteringSampling::full || !r.media_scattering ||
            positional_lights(scene).empty())
            plan.error_unknown.clear();
        else
            plan.error_unknown = "pixels between the marched rays share their errors";
        plan_single_scattering(plan, scene, r, settings_);
        if (!r.media_scattering || positional_lights(scene).empty()) return plan;
        if (settings_.sampling == ScatteringSampling::full)
            plan.run("sampling", "every pixel's ray is marched", "full rate");
        else
            plan.run("sampling",
                     fmt::format("a ray every {} pixels, bilateral upsampling", settings_.spacing),
                     "sub-sampled; pixels that no ray around them continues are marched");
        return plan;
    }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_single_scattering_estimator(scene, options, settings_);
    }

  private:
    ScatteringSettings settings_;
};

}  // namespace

std::shared_ptr<const Integrator> make_single_scattering(const EyePathLimits& limits) {
    return std::make_shared<const MoteSingleScattering>(scattering_settings(limits, ScatteringLights::other));
}

void register_mote_single_scattering(Registry& registry) {
    using S = ScatteringSettings;
    const ParameterList<S> parameters{
        scattering_parameters(),
        row("sampling", &S::sampling,
            {{"full", ScatteringSampling::full}, {"sub_sampled", ScatteringSampling::sub_sampled}},
            "full: every pixel is marched; sub_sampled: rays on a grid, with bilateral upsampling"),
        row("spacing", &S::spacing, between(0.25, 1e6, "pixels"),
            "spacing of the grid when sub-sampled: time falls with its square, shafts are blurred by it")};
    add_type(registry, Category::integrator, "mote_single_scattering",
             "Light scattered at most once, by ray marching: at full rate the reference of mote_epipolar.",
             parameters,
             R"(<integrator type="mote_single_scattering"><integer name="steps" value="128"/></integrator>)",
             [](S settings, const Properties& p) {
                 if (p.has("spacing") && settings.sampling == ScatteringSampling::full)
                     p.warn("spacing has no effect: sampling is full");
                 return std::make_shared<MoteSingleScattering>(std::move(settings));
             });
}

}  // namespace mote::integrators
