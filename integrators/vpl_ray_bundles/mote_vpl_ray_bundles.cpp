// `mote_vpl_ray_bundles`: virtual point lights, and bundles of parallel rays from what the eye sees, combined
// by multiple importance sampling (Tokuyoshi & Ogaki 2012), on surfaces.
//
// As `mote_vpl`: every pass traces a fresh set of light paths and gathers their VPLs at the first connectable
// vertex of every pixel's eye path; direct light is computed apart. Besides, rays leave these vertices along
// a few directions that all pixels share, and what they find is lit in turn. Where two points are close, VPLs
// spike and bundles do not; where a small spot is bright, bundles miss it and VPLs do not. Weighed against
// each other nothing has to be bounded, and the mean is right.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/transport_layers.h"
#include "integrators/register_parts.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_estimator.h"

namespace mote::integrators {

using namespace core;
using gathering::Techniques;
namespace {

float non_negative(const Properties& p, const std::string& name, double usual) {
    const double x = p.get_float(name, usual);
    if (!(x >= 0.0 && x < 1e6)) throw InputError(name + " must be 0 or more and below 1e6", p.where_of(name));
    return float(x);
}

class MoteVplRayBundles final : public Integrator {
  public:
    explicit MoteVplRayBundles(const Properties& p) {
        settings_.eye = read_eye_path_limits(p);
        settings_.eye.max_scatterings = 1;  // from then on virtual lights and bundles take over
        settings_.paths = std::uint32_t(p.get_int_in("paths", 64, 0, std::int64_t(1) << 26));
        settings_.directions = std::uint32_t(p.get_int_in("directions", 8, 0, 65536));
        settings_.joined = std::uint32_t(p.get_int_in("joined", 4, 0, 65536));
        settings_.continuation = float(p.get_float("continuation", 0.25));
        if (!(settings_.continuation >= 0.0f && settings_.continuation < 1.0f))
            throw InputError("continuation must be at least 0 and below 1", p.where_of("continuation"));
        settings_.direct_paths = int(p.get_int_in("direct_paths", 0, 0, 4096));
        const std::string techniques =
            p.get_choice("techniques", "combined", {"combined", "vpls", "bundles"});
        settings_.techniques = techniques == "vpls"      ? Techniques::vpls
                               : techniques == "bundles" ? Techniques::bundles
                                                         : Techniques::combined;
        if (p.has("bound")) {
            const double bound = p.require_float("bound");
            if (!(bound > 0.0) || !std::isfinite(float(bound)))
                throw InputError("bound must be positive and finite", p.where_of("bound"));
            settings_.bound = float(bound);
        }
        settings_.sky = p.get_bool("sky", false);
        settings_.own_rays = p.get_bool("own_rays", true);
        settings_.two_way = p.get_bool("two_way", true);
        settings_.bounces = int(p.get_int_in("bounces", 0, 0, 1000));
        settings_.repeats = p.get_bool("repeats", false);
        const std::string links = p.get_choice("links", "rays", {"rays", "grid", "imperfect"});
        settings_.keeps_links = links != "rays", settings_.links.imperfect = links == "imperfect";
        settings_.links.spacing = non_negative(p, "link_spacing", 0.0);
        settings_.links.points = std::uint32_t(p.get_int_in("link_points", 16384, 1, 1 << 24));
        settings_.links.splat_size = non_negative(p, "splat_size", 1.4);
        if (settings_.links.splat_size == 0.0f)
            throw InputError("splat_size must be above 0", p.where_of("splat_size"));
        if (settings_.bounces > 0 && settings_.techniques != Techniques::bundles)
            throw InputError(
                "bounces along directions of the same pass are paths of bundles alone: "
                "techniques=\"bundles\"",
                p.where_of("bounces"));
        if (settings_.bounces > int(settings_.directions) && !settings_.repeats)
            throw InputError(
                "a path of " + std::to_string(settings_.bounces) + " bounces needs as many directions",
                p.where_of("bounces"));
        settings_.clamping.enabled = p.get_bool("roughness_clamping", false);
        settings_.clamping.neighbours = std::uint32_t(p.get_int_in("clamping_neighbours", 16, 1, 1000));
        settings_.interleaving = int(p.get_int_in("interleaving", 1, 1, 8));
        settings_.filters = p.get_bool("filter", false);
        settings_.filter = read_layer_filter(p);
    }

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
                "mote_vpl_ray_bundles renders surfaces only, and the scene has media; volpath and "
                "mote_vpl render them");
        if (settings_.keeps_links && scene.has_panes())
            throw InputError(
                "links of bundles that are kept know no panes or masks, and the scene has some: "
                "links=\"rays\"");
        return make_vpl_bundle_estimator(scene, options, settings_);
    }

  private:
    /// Of the layers that are not the true transport.
    std::string suffix() const {
        if (settings_.clamping.enabled) return "_roughened";
        return settings_.bound ? "_bounded" : "";
    }
    void plan_techniques(Plan& plan) const;
    void plan_bias(Plan& plan) const;
    VplBundleSettings settings_;
};

void MoteVplRayBundles::plan_techniques(Plan& plan) const {
    plan.run(
        "direct light", fmt::format("{} eye paths a pixel and pass", settings_.direct_paths_of_pass()),
        settings_.direct_paths > 0 ? "asked for" : "by the work on indirect light, of the first of them");
    plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    if (!settings_.has_bundles()) {
        plan.leave_out("bundles", "no rays leave what the eye sees",
                       "virtual point lights alone are asked for");
        return;
    }
    plan.run("bundles", std::to_string(settings_.directions) + " directions a pass",
             settings_.sky ? "half of them by the light of the sky" : "uniform; a line serves both ways");
    plan.run("weights", settings_.techniques == Techniques::combined ? "balance heuristic" : "bundles alone",
             settings_.techniques == Techniques::combined
                 ? "bundles take what is close to the receiver, virtual point lights what is far"
                 : "asked for: virtual point lights are left what bundles cannot make");
    if (settings_.bounces > 0)
        plan.run("bounces", std::to_string(settings_.bounces) + " along directions of the same pass",
                 "one chosen at random for each: the bundles of a pass are used again");
    else
        plan.run("bounces",
                 std::to_string(settings_.joined) + " virtual point lights for each point of a bundle",
                 settings_.bound ? "bounded" : "weighed against the virtual point light at that point");
    if (settings_.continuation_of_pass() > 0.0f)
        plan.run("paths of bundles", fmt::format("go on by a chance of {:.4g}", settings_.continuation),
                 "light between surfaces that are close to each other and to the receiver");
    if (settings_.own_rays && settings_.bounces == 0)
        plan.run("glossy surfaces", "one ray of their own, by the BSDF", "lines do not follow narrow lobes");
    if (settings_.interleaving > 1)
        plan.run("interleaving",
                 "directions and a share of the VPLs for each pixel of " +
                     std::to_string(settings_.interleaving) + " x " + std::to_string(settings_.interleaving),
                 "unbiased: noise differs from pixel to pixel, and less work is done");
}

void MoteVplRayBundles::plan_bias(Plan& plan) const {
    if (settings_.techniques == Techniques::vpls || !settings_.has_bundles())
        plan.run("bound", "none", "right in the mean, with splotches around VPLs");
    if (settings_.bound)
        plan.miss("short distances", "light of two bounces and more between close points is darkened",
                  "bound is set; without it these paths are weighed and nothing is missing");
    if (settings_.bounces > 0)
        plan.miss("light of more bounces", "no more than " + std::to_string(settings_.bounces), "asked for");
    if (settings_.keeps_links)
        plan.miss(
            "links of bundles",
            settings_.links.imperfect ? "those of a grid through discs around points" : "those of a grid",
            settings_.links.imperfect
                ? "asked for: holes between discs let light through, and edges move by up to a disc"
                : "asked for: edges and contacts move by up to half a spacing of its rays");
    if (settings_.bounces > 1 && settings_.repeats)
        plan.miss("independent directions", "a path may take a direction again, and goes straight back then",
                  "asked for: biased by about one over the number of directions");
    if (settings_.joined == 0 && settings_.techniques == Techniques::combined)
        plan.run("paths of two bounces", "virtual point lights alone", "joined is 0: splotches are left");
    if (settings_.joined == 0 && settings_.techniques == Techniques::bundles)
        plan.run("paths of two bounces", "virtual point lights alone", "joined is 0");
    if (settings_.clamping.enabled)
        plan.miss("sharp reflections of indirect light", "roughness clamping blurs them",
                  "asked for: biased; more passes do not sharpen them, more light paths do");
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
                 "asked for; that of all other lights by connections");
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
    auto parameters = eye_path_parameters();
    parameters.push_back({"paths", "integer", "64", "light paths traced in every pass"});
    parameters.push_back({"directions", "integer", "8",
                          "lines along which rays leave what the eye sees, in every pass; 0: none"});
    parameters.push_back(
        {"joined", "integer", "4",
         "virtual point lights that each point found by a ray is joined to, for light of two "
         "bounces and more"});
    parameters.push_back({"techniques", "string", "combined",
                          "combined: weighed against each other; vpls or bundles: one alone"});
    parameters.push_back(
        {"bound", "float", "none",
         "bound [1/m^2] on the geometry term of paths of two bounces and more, which are left "
         "to bundles then, as in the paper; none: they are weighed, and nothing is lost"});
    parameters.push_back(
        {"sky", "boolean", "false",
         "direct light of the sky by bundles too, half of whose directions are drawn by it"});
    parameters.push_back(
        {"own_rays", "boolean", "true",
         "a glossy surface also sends one ray by its BSDF, weighed against the lines; false: "
         "lines alone, as in the paper"});
    parameters.push_back({"two_way", "boolean", "true",
                          "false: a direction serves one way, as a shadow map does, for comparison"});
    parameters.push_back({"continuation", "float", "0.25",
                          "chance of a path that a bundle began to go on from each point that it found; "
                          "weighed against all other "
                          "techniques, with techniques=\"combined\" and without a bound alone"});
    parameters.push_back({"direct_paths", "integer", "0",
                          "eye paths a pixel and pass whose direct light counts, in the mean; indirect light "
                          "is gathered for the "
                          "first of them. 0: as many as the work on indirect light suggests"});
    parameters.push_back(
        {"bounces", "integer", "0",
         "for bundles alone: bounces of paths along directions of the same pass, chosen at random, "
         "instead of joined virtual point lights; 0: none"});
    parameters.push_back({"repeats", "boolean", "false",
                          "such a path may take a direction again: biased by about one over their number"});
    parameters.push_back(
        {"links", "string", "rays",
         "what a line finds: by 'rays' of each point, exact; looked up in bundles that are kept, "
         "through the triangles ('grid') or through discs around points ('imperfect')"});
    parameters.push_back({"link_spacing", "float", "0",
                          "between the rays of kept bundles [m]; 0: 1/256 of the scene's diagonal"});
    parameters.push_back({"link_points", "integer", "16384", "of an imperfect bundle"});
    parameters.push_back({"splat_size", "float", "1.4",
                          "radius of their discs; at 1 they have the area of all surfaces together"});
    parameters.push_back({"roughness_clamping", "boolean", "false",
                          "widen glossy lobes to the density of the light that is known: biased"});
    parameters.push_back(
        {"clamping_neighbours", "integer", "16", "m': a lobe reaches over so many lights of a pass"});
    parameters.push_back(
        {"interleaving", "integer", "1",
         "n, up to 8: a pixel of n x n has directions of its own, and every n^2-th VPL, which "
         "counts n^2 times"});
    parameters.push_back({"filter", "boolean", "false",
                          "smooth indirect light in image space, as far as noise that differs from pixel to "
                          "pixel explains its "
                          "detail: for interleaving"});
    for (Parameter& p : layer_filter_parameters()) parameters.push_back(std::move(p));
    registry.add(
        {Category::integrator, "mote_vpl_ray_bundles",
         "Virtual point lights combined with bundles of parallel rays from what the eye sees (Tokuyoshi & "
         "Ogaki "
         "2012), for scenes without media. Unbiased, without splotches in corners.",
         parameters,
         R"(<integrator type="mote_vpl_ray_bundles"><integer name="directions" value="16"/></integrator>)"},
        [](const Properties& p) { return std::make_shared<MoteVplRayBundles>(p); });
}

}  // namespace mote::integrators
