// `mote_bdpt`: bidirectional path tracing on surfaces and in media (Veach 1997; Sun 2020), unbiased.
#include "integrators/bidirectional/bidirectional_estimator.h"
#include "integrators/bidirectional/strategy_layers.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

Heuristic heuristic_from(const Properties& properties) {
    const std::string name = properties.get_string("heuristic", "power");
    if (name == "power") return Heuristic::power;
    if (name == "balance") return Heuristic::balance;
    if (name == "none") return Heuristic::none;
    throw InputError("heuristic is one of power, balance, none, not '" + name + "'",
                     properties.where_of("heuristic"));
}

class MoteBdpt final : public Integrator {
  public:
    explicit MoteBdpt(const Properties& properties) {
        settings_.limits = read_eye_path_limits(properties);
        settings_.heuristic = heuristic_from(properties);
        settings_.all_connections = properties.get_bool("all_connections", false);
        settings_.strategies = int(properties.get_int_in("strategies", 0, 0, 8));
    }

    std::string type() const override { return "mote_bdpt"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        auto layers = transport_layers(scene.has_media(), false);
        append_strategy_layers(layers, settings_.strategies);
        return layers;
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media()) return make_bidirectional_estimator<true>(scene, options, settings_);
        return make_bidirectional_estimator<false>(scene, options, settings_);
    }

  private:
    BidirectionalSettings settings_;
};

Plan MoteBdpt::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.run(
        "paths", "one from the eye and one from a light per pixel and pass",
        "joined in every way: lights that are hit, drawn lights, connections, light traced to the camera");
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
                                       : "drawn among those with all vertices of the light path");
    plan_media(plan, r);
    if (r.lights_media > 0)
        plan.run("emission of media", "met by eye paths alone", "no light path starts in a medium");
    plan_choice_of_lights(plan, scene);
    return plan;
}

}  // namespace

void register_mote_bdpt(Registry& registry) {
    auto parameters = eye_path_parameters();
    parameters.push_back(
        {"heuristic", "string", "power",
         "weights of the techniques that find the same path: power, balance; none: all count "
         "in full, to look at them by `strategies`"});
    parameters.push_back({"all_connections", "boolean", "false",
                          "test every connection of an eye vertex with the light path; false: one, drawn by "
                          "what they would bring if nothing were in between"});
    parameters.push_back({"strategies", "integer", "0",
                          "a layer s<vertices from a light>_t<vertices from the camera> for every technique "
                          "of paths of up to so many edges, at most 8"});
    registry.add(
        {Category::integrator, "mote_bdpt", "Unbiased bidirectional path tracer for surfaces and media.",
         parameters, R"(<integrator type="mote_bdpt"><integer name="max_depth" value="-1"/></integrator>)"},
        [](const Properties& p) { return std::make_shared<MoteBdpt>(p); });
}

}  // namespace mote::integrators
