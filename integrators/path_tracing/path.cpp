// `path`: the unbiased path tracer for scenes without media.
//
// Surfaces only: media are not seen, as in Mitsuba 3. Next-event estimation and BSDF sampling are combined by
// multiple importance sampling.
#include "integrators/path_tracing/path_estimator.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

struct SurfacePathSettings {
    EyePathLimits limits;
    GuidingSettings guiding;
};

class Path final : public Integrator {
  public:
    explicit Path(const SurfacePathSettings& s) : settings_{.limits = s.limits, .guiding = s.guiding} {}

    std::string type() const override { return "path"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false); }

    Plan plan(const Scene& scene, const Requirements& requirements) const override {
        Plan plan;
        plan.integrator = type();
        if (!scene.has_media()) plan.error_unknown.clear();
        plan.run("paths", "one per pixel and pass", "light and BSDF sampling combined at every vertex");
        if (requirements.any_media())
            plan.miss("media", std::to_string(requirements.media) + " not rendered",
                      "path traces surfaces only; volpath renders media");
        else
            plan.leave_out("media", "no code for media runs", "the scene has none");
        plan_guiding(plan, settings_.guiding, requirements, false);
        plan_choice_of_lights(plan, scene);
        plan_samples_of_lights(plan, scene);
        plan_caustics(plan, scene, requirements);
        return plan;
    }
    bool renders_columns() const override { return settings_.guiding.mode == Guiding::off; }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_path_estimator<false>(scene, options, settings_);
    }

  private:
    PathSettings settings_;
};

}  // namespace

std::shared_ptr<const Integrator> make_path(const EyePathLimits& limits) {
    return std::make_shared<const Path>(SurfacePathSettings{limits, {}});
}

void register_path(Registry& registry) {
    using S = SurfacePathSettings;
    add_type<S>(registry, Category::integrator, "path",
                "Unbiased path tracer for surfaces; media are not seen.",
                {within(&S::limits, eye_path_rows()), within(&S::guiding, guiding_rows())},
                R"(<integrator type="path"><integer name="max_depth" value="8"/></integrator>)",
                [](const S& s) { return std::make_shared<Path>(s); });
}

}  // namespace mote::integrators
