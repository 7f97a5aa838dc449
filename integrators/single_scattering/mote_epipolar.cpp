// `mote_epipolar`: light scattered once in media, from rays marched along epipolar lines.
//
// Engelhardt 2013, chapter 9 (Engelhardt & Dachsbacher 2010), for every light that has a position, in
// homogeneous and heterogeneous media. Surfaces, and lights without a position, are rendered at full rate.
#include <fmt/format.h>

#include "integrators/register_parts.h"
#include "integrators/single_scattering/single_scattering_estimator.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteEpipolar final : public Integrator {
  public:
    explicit MoteEpipolar(const Properties& p) : settings_(read_scattering_settings(p)) {
        settings_.sampling = ScatteringSampling::epipolar;
        settings_.lines = int(p.get_int_in("lines", 1024, 1, 1 << 20));
        settings_.line.initial = int(p.get_int_in("samples", 16, 2, 1 << 20));
        settings_.line.texels = p.get_float_in("texels", 1.0, 1e-3, 64.0);
        settings_.line.tolerance = float(p.get_float_in("tolerance", 0.05, 0.0, 1e6));
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

std::shared_ptr<const Integrator> make_epipolar(const EyePathLimits& limits, int lines, int samples) {
    Properties properties = scattering_properties(limits, "positional");
    properties.values["lines"] = {std::int64_t(lines), {}};
    properties.values["samples"] = {std::int64_t(samples), {}};
    return std::make_shared<const MoteEpipolar>(properties);
}

void register_mote_epipolar(Registry& registry) {
    auto parameters = scattering_parameters();
    parameters.push_back(
        {"lines", "integer", "1024", "epipolar lines of every light, around the whole picture"});
    parameters.push_back({"samples", "integer", "16", "marched rays spread evenly along a line"});
    parameters.push_back(
        {"texels", "float", "1", "places for samples, and for edges to be found, a pixel of a line"});
    parameters.push_back(
        {"tolerance", "float", "0.05",
         "lines are refined where light or transmittance varies by more; 0: at edges in depth alone"});
    registry.add(
        {Category::integrator, "mote_epipolar",
         "Light scattered at most once; in media from rays marched along epipolar lines.", parameters,
         R"(<integrator type="mote_epipolar"><integer name="lines" value="512"/></integrator>)"},
        [](const Properties& p) { return std::make_shared<MoteEpipolar>(p); });
}

}  // namespace mote::integrators
