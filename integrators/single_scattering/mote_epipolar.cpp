// `mote_epipolar`: light scattered once in media, from rays marched along epipolar lines.
//
// Engelhardt 2013, chapter 9 (Engelhardt & Dachsbacher 2010), for every light that has a position, in
// homogeneous and heterogeneous media. Surfaces, and lights without a position, are rendered at full rate.
#include <fmt/format.h>

#include "core/parameters/add_type.h"
#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteEpipolar final : public Integrator {
  public:
    explicit MoteEpipolar(ScatteringSettings settings) : settings_(std::move(settings)) {
        settings_.sampling = ScatteringSampling::epipolar;
    }

    std::string type() const override { return "mote_epipolar"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return single_scattering_layers(scene.has_media(), settings_);
    }
    Plan plan(const Scene& scene, const Requirements& r) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_single_scattering_estimator(scene, options, settings_);
    }

  private:
    ScatteringSettings settings_;
};

Plan MoteEpipolar::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.error_unknown.clear();  // but for steps of marching and gaps between samples, whose bias is small
    plan_single_scattering(plan, scene, r, settings_);
    const std::size_t lights = positional_lights(scene).size();
    if (!r.media_scattering)
        plan.leave_out("epipolar sampling", "no lines",
                       r.any_media() ? "no medium scatters" : "the scene has no medium");
    else if (lights == 0)
        plan.leave_out("epipolar sampling", "no lines", "no light has a position");
    if (!r.media_scattering || lights == 0) return plan;
    plan.run("epipolar lines",
             fmt::format("{} for each of {} light{}", settings_.lines, lights, lights == 1 ? "" : "s"),
             "Engelhardt 2013, Sec. 9.2.1; a light at the eye gets a regular grid");
    plan.run("samples of a line",
             fmt::format("{} evenly spread, two at every discontinuity, {} at most", settings_.line.initial,
                         settings_.line.cap),
             "pixels that no line continues are marched themselves");
    plan.run("interpolation", fmt::format("between places {:.3g} pixel apart", 1.0 / settings_.line.texels),
             "a voxel much brighter than what is around it is blurred so far, also into the film");
    if (settings_.line.tolerance > 0.0f)
        plan.run("refinement",
                 fmt::format("where light or transmittance varies by more than {}", settings_.line.tolerance),
                 "shadows and heterogeneous media, which have no edge in depth");
    else
        plan.leave_out("refinement", "edges in depth alone", "tolerance is 0");
    if (r.any_delta())
        plan.run("mirrors and glass", "rays behind them are marched at full rate",
                 "they do not start at the eye");
    return plan;
}

}  // namespace

std::shared_ptr<const Integrator> make_epipolar(const EyePathLimits& limits, ScatteringLights which,
                                                int lines, int samples) {
    ScatteringSettings settings = scattering_settings(limits, which);
    settings.lines = lines, settings.line.initial = samples;
    return std::make_shared<const MoteEpipolar>(std::move(settings));
}

void register_mote_epipolar(Registry& registry) {
    using S = ScatteringSettings;
    using screenspace::LineSampling;
    const ParameterList<S> parameters{
        scattering_parameters(),
        row("lines", &S::lines, between(1, 1 << 20),
            "epipolar lines of every light, around the whole picture: finer shafts, cost in proportion"),
        within(
            &S::line,
            row("samples", &LineSampling::initial, between(2, 1 << 20),
                "marched rays spread evenly along a line: from 8 on hardly any error is left to them"),
            row("texels", &LineSampling::texels, between(1e-3, 64, "1/pixel"),
                "positions of samples along a line, and of edges: thinner shafts are found, for a ray each"),
            row("tolerance", &LineSampling::tolerance, between(0, 1e6),
                "lines are refined where light or transmittance varies by more: fewer rays and more "
                "error along lines; 0: at edges in depth alone"))};
    add_type(registry, Category::integrator, "mote_epipolar",
             "Light scattered at most once; in media from rays marched along epipolar lines.", parameters,
             R"(<integrator type="mote_epipolar"><integer name="lines" value="512"/></integrator>)",
             [](S settings) { return std::make_shared<MoteEpipolar>(std::move(settings)); });
}

}  // namespace mote::integrators
