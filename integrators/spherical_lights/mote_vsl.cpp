// `mote_vsl`: light from virtual spherical lights (Hasan et al. 2009), on surfaces.
//
// As `mote_vpl`: every pass traces a fresh set of light paths, leaves a VPL at each of their vertices, and
// gathers all of them at the first connectable vertex of every pixel's eye path; direct light is computed
// apart. Here every VPL is a sphere that reaches to its k-th nearest neighbour, so that nothing has to be
// bounded, also between glossy surfaces. In return light is blurred over the spheres: a bias that more passes
// do not reduce, since each has spheres of the same size; more light paths a pass do.
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/path_tracing/unbiased_paths.h"
#include "integrators/register_parts.h"
#include "integrators/spherical_lights/vsl_settings.h"

namespace mote::integrators {

using namespace core;
namespace {

class MoteVsl final : public Integrator {
  public:
    explicit MoteVsl(const VslSettings& settings) : settings_(settings) {
        settings_.eye.max_scatterings = 1;  // from then on spherical lights take over
    }

    std::string type() const override { return "mote_vsl"; }
    std::vector<Layer> layers(const Scene&) const override { return transport_layers(false, "_spherical"); }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::shared_ptr<const Integrator> control(const Scene& scene) const override {
        return unbiased_paths(scene, settings_.eye);
    }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media())
            throw InputError(
                "mote_vsl renders surfaces only, and the scene has media; volpath and mote_vpl render them");
        return make_vsl_estimator(scene, options, settings_);
    }

  private:
    VslSettings settings_;
};

Plan MoteVsl::plan(const Scene& scene, const Requirements& r) const {
    const auto& gather = settings_.gather;
    Plan plan;
    plan.integrator = type();
    plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    plan.run("radius",
             std::to_string(gather.radius_scale) + " times the distance to neighbour " +
                 std::to_string(gather.neighbours),
             "a light covers the disc that its neighbours leave to it");
    plan.run("directions", std::to_string(gather.samples) + " a light",
             r.any_glossy() ? "from the cone and from glossy BSDFs at both ends, balance heuristic"
                            : "from the cone: every surface is diffuse");
    if (gather.visibility == compensation::SphereVisibility::per_sample)
        plan.run("visibility", "a shadow ray a direction", "soft where a sphere is partly hidden");
    else
        plan.run("visibility", "a shadow ray to the centre of every sphere", "requested");
    plan_choice_of_lights(plan, scene);
    plan.miss("detail of indirect light", "blurred over the spheres",
              "more passes do not sharpen it, more light paths do");
    if (r.any_delta())
        plan.miss("caustics", "light that reaches a receiver through a delta surface",
                  "a VPL cannot be connected through mirrors and glass; volpath renders it");
    if (r.any_media())
        plan.miss("the whole picture", "refused: the scene has media",
                  "spherical lights are for surfaces; volpath and mote_vpl render media");
    else
        plan.leave_out("media", "no code for media runs", "the scene has none");
    plan_control(plan, scene, r, settings_.eye);
    return plan;
}

}  // namespace

void register_mote_vsl(Registry& registry) {
    using S = VslSettings;
    using Gather = compensation::SphericalGather;
    using compensation::SphereVisibility;
    add_type<S>(
        registry, Category::integrator, "mote_vsl",
        "Virtual spherical lights (Hasan et al. 2009), for scenes without media: no splotches between "
        "glossy surfaces, and nothing bounded, but indirect light is blurred over the spheres. More "
        "passes remove noise only; the blur shrinks with more light paths a pass.",
        {within(&S::eye, eye_path_rows()),
         row("paths", &S::paths, between(0, 1 << 26), "Light paths traced in every pass."),
         within(&S::gather,
                row("neighbours", &Gather::neighbours, between(1, 1000),
                    "k: a sphere reaches to the k-th nearest other light of its pass."),
                row("radius_scale", &Gather::radius_scale, between(0, 1e6),
                    "Factor on the radius; 0: points, as mote_vpl without a bound."),
                row("samples", &Gather::samples, between(1, 4096), "Directions a light, for every receiver."),
                row("visibility", &Gather::visibility,
                    {{"sample", SphereVisibility::per_sample}, {"light", SphereVisibility::per_light}},
                    "sample: a shadow ray along every direction, up to the sphere; light: one to the "
                    "centre, faster with shadow edges as hard as a point's."))},
        R"(<integrator type="mote_vsl"><integer name="paths" value="512"/></integrator>)",
        [](const S& s) { return std::make_shared<MoteVsl>(s); });
}

}  // namespace mote::integrators
