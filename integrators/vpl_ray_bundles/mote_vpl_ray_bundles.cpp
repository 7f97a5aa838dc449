// `mote_vpl_ray_bundles`: virtual point lights, and bundles of parallel rays from what the eye sees, combined
// by multiple importance sampling (Tokuyoshi & Ogaki 2012), on surfaces.
//
// As `mote_vpl`: every pass traces a fresh set of light paths and gathers their VPLs at the first connectable
// vertex of every pixel's eye path; direct light is computed apart. Besides, rays leave these vertices along
// a few directions that all pixels share, and what they find is lit in turn. Where two points are close, VPLs
// spike and bundles do not; where a small spot is bright, bundles miss it and VPLs do not. Weighted against
// each other nothing has to be bounded, and the mean is right.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/transport_layers.h"
#include "integrators/register_parts.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_settings.h"

namespace mote::integrators {

using namespace core;
namespace {

VplBundleSettings defaults() {
    VplBundleSettings s;
    s.eye.max_scatterings = 1;  // VPLs and bundles take over from there
    return s;
}

const ParameterList<VplBundleSettings>& vpl_bundle_parameters() {
    using S = VplBundleSettings;
    static const ParameterList<S> list(
        defaults(),
        {within(&S::eye, eye_path_rows()),
         row("paths", &S::paths, between(0, 1 << 26),
             "Light paths traced in every pass: time grows with them, variance falls."),
         row("directions", &S::directions, between(0, 65536),
             "Lines along which rays leave what the eye sees, in every pass: time grows with them, variance "
             "falls; 0: none."),
         row("techniques", &S::choice,
             {{"combined", BundleTechniques::combined},
              {"vpls", BundleTechniques::vpls},
              {"bundles", BundleTechniques::bundles},
              {"reused_bundles", BundleTechniques::reused_bundles}},
             "combined: VPLs and bundles with MIS weights. vpls, bundles: one alone, with several times the "
             "error. reused_bundles: bundles alone, whose paths continue along the other directions of their "
             "pass; time grows with their bounces."),
         row("bound", &S::bound, above(0, "1/m^2"),
             "Bound on the geometry term of paths of two bounces and more, which are left to bundles then, "
             "as in the paper: darker. Without it they have MIS weights, and nothing is lost.")
             .when_absent("none"),
         row("sky", &S::sky,
             "Direct light of the sky by bundles too, half of whose directions are sampled by it."),
         row("glossy", &S::glossy,
             {{"own_rays", GlossyTreatment::own_rays},
              {"lines", GlossyTreatment::lines},
              {"clamping", GlossyTreatment::clamping}},
             "own_rays: a glossy surface also sends one ray by its BSDF, with MIS weights. lines: lines "
             "alone, as in the paper, with nearly twice the error. clamping: lobes widened to the density of "
             "the "
             "lights, biased."),
         row("links", &S::imperfect_links, {{"rays", false}, {"imperfect", true}},
             "rays: a ray of each point finds what a line meets, exact. imperfect: looked up in bundles of "
             "discs around points, which lose light through holes."),
         row("interleaving", &S::interleaving, between(1, 8),
             "n: a pixel of n x n has directions of its own, and every n^2-th VPL, which counts n^2 times: "
             "less work a pass, and more noise."),
         row("filter", &S::filters,
             "Smooths indirect light in image space, as far as noise that differs from pixel to pixel "
             "explains its detail: for interleaving.")});
    return list;
}

class MoteVplRayBundles final : public Integrator {
  public:
    explicit MoteVplRayBundles(const VplBundleSettings& settings) : settings_(settings) {}

    std::string type() const override { return "mote_vpl_ray_bundles"; }
    bool works_on_mean() const override { return settings_.filters; }
    std::vector<Layer> layers(const Scene&) const override {
        auto layers = transport_layers(false, suffix());
        layers[std::size_t(Transport::indirect)].squares = settings_.filters;
        return layers;
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media())
            throw InputError(
                "mote_vpl_ray_bundles renders surfaces only, and the scene has media; volpath and mote_vpl "
                "render them");
        if (settings_.imperfect_links && scene.has_panes())
            throw InputError(
                "imperfect bundles have no panes or masks, and the scene has some: links=\"rays\"");
        return make_vpl_bundle_estimator(scene, options, settings_);
    }

  private:
    /// Suffix of the layers that are not the true transport.
    std::string suffix() const {
        if (settings_.glossy == GlossyTreatment::clamping) return "_roughened";
        return settings_.bound ? "_bounded" : "";
    }
    void plan_techniques(Plan& plan) const;
    void plan_bias(Plan& plan) const;
    VplBundleSettings settings_;
};

void MoteVplRayBundles::plan_techniques(Plan& plan) const {
    plan.run("direct light", fmt::format("{} eye paths a pixel and pass", settings_.direct_paths()),
             "by the work on indirect light, of the first of them");
    plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    if (!settings_.has_bundles()) {
        plan.leave_out("bundles", "no rays leave what the eye sees",
                       "virtual point lights alone are requested");
        return;
    }
    plan.run("bundles", std::to_string(settings_.directions) + " directions a pass",
             settings_.sky ? "half of them by the light of the sky" : "uniform; a line serves both ways");
    plan.run("weights",
             settings_.choice == BundleTechniques::combined ? "balance heuristic" : "bundles alone",
             settings_.choice == BundleTechniques::combined
                 ? "bundles take what is close to the receiver, virtual point lights what is far"
                 : "requested: virtual point lights are left what bundles cannot make");
    if (settings_.reuses_lines())
        plan.run("bounces", std::to_string(settings_.bounces()) + " along directions of the same pass",
                 "in random order: the bundles of a pass are used again");
    else
        plan.run("bounces",
                 std::to_string(settings_.joined) + " virtual point lights for each point of a bundle",
                 settings_.bound ? "bounded" : "weighted against the virtual point light at that point");
    if (settings_.continuation_of_pass() > 0.0f)
        plan.run("paths of bundles", fmt::format("continue by a chance of {:.4g}", settings_.continuation),
                 "light between surfaces that are close to each other and to the receiver");
    if (settings_.glossy == GlossyTreatment::own_rays && !settings_.reuses_lines())
        plan.run("glossy surfaces", "one ray of their own, by the BSDF", "lines do not follow narrow lobes");
    if (settings_.interleaving > 1)
        plan.run("interleaving",
                 "directions and a share of the VPLs for each pixel of " +
                     std::to_string(settings_.interleaving) + " x " + std::to_string(settings_.interleaving),
                 "unbiased: noise differs from pixel to pixel, and less work is done");
}

void MoteVplRayBundles::plan_bias(Plan& plan) const {
    if (settings_.choice == BundleTechniques::vpls || !settings_.has_bundles())
        plan.run("bound", "none", "right in the mean, with splotches around VPLs");
    if (settings_.bound)
        plan.miss("short distances", "light of two bounces and more between close points is darkened",
                  "bound is set; without it these paths are weighted and nothing is missing");
    if (settings_.reuses_lines())
        plan.miss("light of more bounces", "no more than " + std::to_string(settings_.bounces()),
                  "a path takes each line once, and max_depth limits it");
    if (settings_.imperfect_links)
        plan.miss("links of bundles", "those of a grid through discs around points",
                  "links is 'imperfect': holes between discs let light through, and edges move by up to a "
                  "disc");
    if (settings_.glossy == GlossyTreatment::clamping)
        plan.miss("sharp reflections of indirect light", "roughness clamping blurs them",
                  "requested: biased; more passes do not sharpen them, more light paths do");
    if (settings_.filters)
        plan.run(
            "filter", "indirect light in image space",
            "biased by what it smoothes, less with every pass. The noise that is stated, and --noise, are "
            "those of the passes before it");
}

Plan MoteVplRayBundles::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan_techniques(plan);
    plan_bias(plan);
    plan_choice_of_lights(plan, scene);
    if (settings_.sky && scene.environment())
        plan.run("direct light of the sky", "by bundles",
                 "requested; that of all other lights by connections");
    if (r.any_delta())
        plan.miss(
            "caustics", "light that reaches a receiver through a delta surface",
            "neither VPLs nor points of bundles can be connected through mirrors and glass; path renders it");
    if (r.any_media())
        plan.miss("the whole picture", "refused: the scene has media",
                  "bundles are for surfaces; volpath and mote_vpl render media");
    else
        plan.leave_out("media", "no code for media runs", "the scene has none");
    return plan;
}

}  // namespace

void register_mote_vpl_ray_bundles(Registry& registry) {
    add_type(
        registry, Category::integrator, "mote_vpl_ray_bundles",
        "Virtual point lights combined with bundles of parallel rays from what the eye sees (Tokuyoshi & "
        "Ogaki 2012), for scenes without media. Unbiased, without splotches in corners.",
        vpl_bundle_parameters(),
        R"(<integrator type="mote_vpl_ray_bundles"><integer name="directions" value="16"/></integrator>)",
        [](const VplBundleSettings& s) { return std::make_shared<MoteVplRayBundles>(s); });
}

}  // namespace mote::integrators
