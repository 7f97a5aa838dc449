// `volpath`: the unbiased volumetric path tracer, the reference of everything in this project.
//
// Delta tracking for distances, ratio tracking for connections, spectral multiple importance sampling over
// the channel that drives tracking, light and scattering directions combined at every vertex. On a scene
// without media it is `path`, compiled from the same kernel.
//
// `vpl_bound` renders the transport that VPLs with a bounded geometry term estimate (see trace_paths.h).
#include <fmt/format.h>

#include "integrators/path_tracing/path_estimator.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

struct VolpathSettings {
    EyePathLimits limits;
    float vpl_bound = 0.0f;           ///< b [1/m^2]; 0: none
    std::optional<bool> equiangular;  ///< nothing: where lamps stand in media
    GuidingSettings guiding;
};

class Volpath final : public Integrator {
  public:
    explicit Volpath(const VolpathSettings& s)
        : settings_{.limits = s.limits, .guiding = s.guiding}, equiangular_(s.equiangular) {
        if (s.vpl_bound > 0.0f) settings_.bound = s.vpl_bound;
    }

    std::string type() const override { return "volpath"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return transport_layers(scene.has_media(), bounded() ? "_bounded" : "");
    }
    Plan plan(const Scene&, const Requirements& requirements) const override;
    bool renders_columns() const override { return settings_.guiding.mode == Guiding::off; }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (!scene.has_media()) return make_path_estimator<false>(scene, options, settings_);
        PathSettings settings = settings_;
        if (lights_along_rays(scene)) settings.equiangular = std::make_shared<const EquiangularLights>(scene);
        return make_path_estimator<true>(scene, options, settings);
    }

  private:
    bool bounded() const { return std::isfinite(settings_.bound); }
    bool lights_along_rays(const Scene& scene) const {
        return equiangular_.value_or(!bounded() && has_lamps_in_media(scene));
    }
    void plan_equiangular(Plan& plan, const Scene& scene, const Requirements& requirements) const;
    PathSettings settings_;
    std::optional<bool> equiangular_;  ///< nothing: where lamps stand in media
};

void Volpath::plan_equiangular(Plan& plan, const Scene& scene, const Requirements& r) const {
    const bool useful = r.media_scattering && r.lights_point > 0;
    if (useful && lights_along_rays(scene))
        plan.run("equi-angular sampling",
                 "for point and spot lights: one distance a ray, one more direction a vertex",
                 equiangular_ ? "requested" : "one stands in a medium");
    else if (equiangular_.value_or(false))
        plan.leave_out("equi-angular sampling", "requested, without effect",
                       r.media_scattering ? "no light has a position" : "no medium scatters");
    else if (useful)
        plan.leave_out("equi-angular sampling", "point lights are connected to collisions",
                       equiangular_
                           ? "equiangular is false; in thin media it would cost less for the same noise"
                           : "no light stands in a medium");
}

Plan Volpath::plan(const Scene& scene, const Requirements& requirements) const {
    Plan plan;
    plan.integrator = type();
    if (bounded())
        plan.error_unknown = "passes are without the light that the bound takes";
    else
        plan.error_unknown.clear();
    plan.run("paths", "one per pixel and pass", "light and scattering directions combined at every vertex");
    plan_guiding(plan, settings_.guiding, requirements, true);
    plan_media(plan, requirements);
    plan_choice_of_lights(plan, scene);
    plan_samples_of_lights(plan, scene);
    plan_medium_lights(plan, requirements);
    if (bounded())
        plan.run("bound", std::to_string(settings_.bound) + " /m^2",
                 "requested: second edges are weighted by min(G*, b)/G*, the transport of bounded VPLs");
    plan_equiangular(plan, scene, requirements);
    plan_caustics(plan, scene, requirements);
    return plan;
}

}  // namespace

std::shared_ptr<const Integrator> make_volpath(const EyePathLimits& limits) {
    return std::make_shared<const Volpath>(VolpathSettings{limits, 0.0f, {}, {}});
}

void register_volpath(Registry& registry) {
    using S = VolpathSettings;
    add_type<S>(
        registry, Category::integrator, "volpath",
        "Unbiased volumetric path tracer: the reference that approximations are held against.",
        {within(&S::limits, eye_path_rows()),
         row("vpl_bound", &S::vpl_bound, at_least(0, "1/m^2"),
             "Bound b on the geometry term of the edge where VPLs connect; 0: none."),
         row("equiangular", &S::equiangular,
             "Light of point and spot lights in media by equi-angular sampling along every ray, instead of "
             "at collisions.")
             .when_absent("true where such a light stands in a medium"),
         within(&S::guiding, guiding_rows())},
        R"(<integrator type="volpath"><integer name="max_depth" value="-1"/></integrator>)",
        [](const S& s, const Properties& p) {
            if (s.equiangular.value_or(false) && s.vpl_bound > 0.0f)
                throw InputError(
                    "equiangular and vpl_bound do not go together: the bound weights edges that end at "
                    "collisions",
                    p.where_of("equiangular"));
            return std::make_shared<Volpath>(s);
        });
}

}  // namespace mote::integrators
