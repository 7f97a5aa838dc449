// `mote_bdpt`: bidirectional path tracing on surfaces and in media (Veach 1997; Sun 2020), unbiased.
#include "integrators/bidirectional/bidirectional_estimator.h"
#include "integrators/bidirectional/strategy_layers.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

class MoteBdpt final : public Integrator {
  public:
    explicit MoteBdpt(const BidirectionalSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_bdpt"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        auto layers = transport_layers(scene.has_media());
        append_strategy_layers(layers, settings_.strategies);
        return layers;
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_bidirectional_estimator(scene, options, settings_);
    }

  private:
    BidirectionalSettings settings_;
};

Plan MoteBdpt::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.run(
        "paths", "one from the eye and one from a light per pixel and pass",
        "joined in every way: lights that are hit, sampled lights, connections, light traced to the camera");
    if (settings_.heuristic == Heuristic::none)
        plan.miss("weights", "every technique counts in full",
                  "heuristic is none: layers are sums of several estimates of the same light");
    else
        plan.run(
            "weights",
            settings_.heuristic == Heuristic::power ? "power heuristic, exponent 2" : "balance heuristic",
            "of all techniques that find the same path; in media by the optical depth of its edges");
    if (settings_.limits.hide_emitters)
        plan.leave_out("light traced to the camera", "not joined to the lens",
                       "hide_emitters: eye rays pass lights that would be in its way");
    plan.run("connections", settings_.all_connections ? "all of each eye vertex" : "one of each eye vertex",
             settings_.all_connections ? "all_connections is true"
                                       : "sampled among those with all vertices of the light path");
    plan_media(plan, r);
    if (r.lights_media > 0)
        plan.run("emission of media", "met by eye paths alone", "no light path starts in a medium");
    plan_choice_of_lights(plan, scene);
    return plan;
}

}  // namespace

void register_mote_bdpt(Registry& registry) {
    using S = BidirectionalSettings;
    add_type<S>(
        registry, Category::integrator, "mote_bdpt",
        "Unbiased bidirectional path tracer for surfaces and media.",
        {within(&S::limits, eye_path_rows()),
         row("heuristic", &S::heuristic,
             {{"power", Heuristic::power}, {"balance", Heuristic::balance}, {"none", Heuristic::none}},
             "Weights of the techniques that find the same path; none: all count in full, to inspect "
             "them by `strategies`."),
         row("all_connections", &S::all_connections,
             "Test every connection of an eye vertex with the light path; false: one, sampled by its "
             "unoccluded contribution."),
         row("strategies", &S::strategies, between(0, 8),
             "A layer s<vertices from a light>_t<vertices from the camera> for every technique of paths of "
             "up to so many edges.")},
        R"(<integrator type="mote_bdpt"><integer name="max_depth" value="-1"/></integrator>)",
        [](const S& s) { return std::make_shared<MoteBdpt>(s); });
}

}  // namespace mote::integrators
