// `mote_vpl`: light from virtual point lights, on surfaces and in media.
//
// Every pass traces a fresh set of light paths, leaves a VPL at each of their vertices, and gathers all of
// them at the first connectable vertex of every pixel's eye path: on a surface, or where delta tracking met
// the medium (Engelhardt 2013, Eqs. 10.4 to 10.9). Light from the primary lights that scatters once is
// computed apart, by next-event estimation and scattering directions, so VPLs represent everything that
// scatters at least twice.
//
// The geometry term G* of a connection is bounded by b (Sec. 10.1.3), which removes the bright splotches
// around VPLs together with the light that travels short distances; unbounded, the mean is right but its
// variance is infinite. Paths that cross a delta surface between the VPL and the receiver cannot be connected
// and are missing.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/eye_path/transport_layers.h"
#include "integrators/register_parts.h"
#include "integrators/virtual_point_lights/plan_selection.h"
#include "integrators/virtual_point_lights/vpl_settings.h"

namespace mote::integrators {

using namespace core;

VplSettings::VplSettings()
    : selection(lights::all_vpls()),
      visibility(lights::traced_visibility()),
      residual(std::make_shared<compensation::Residual>()) {}

namespace {

struct VplFile : VplSettings {
    VplFile() { eye.max_scatterings = 1; }  // from then on virtual lights take over
};

const ParameterList<VplFile>& vpl_rows() {
    using S = VplFile;
    static const ParameterList<S> list{
        within(&S::eye, eye_path_rows()),
        row("paths", &S::paths, between(0, 1 << 26),
            "Light paths traced in every pass, some three VPLs each: time without a selection is in "
            "proportion, and the automatic bound removes less energy."),
        row("reflective_shadow_maps", &S::reflective_maps, between(0, 2048),
            "Texels along an edge of the map of each point, spot and directional light: each begins a light "
            "path, spread more evenly than sampled ones, and `paths` are those of other lights; 0: all "
            "lights sample their paths."),
        row("bound", &S::bound, above(0, "1/m^2").or_else(no_bound, "no bound"),
            "Bound b on the geometry term; lower: less noise, and more energy is removed. automatic: light "
            "paths / R^2 with the radius R of all shapes. Without a bound the mean is right, with infinite "
            "variance near VPLs."),
        nested("compensation", &S::residual, Category::compensation, "none",
               "Method that restores the energy that the bound removes."),
        nested("visibility", &S::visibility, Category::visibility, "traced",
               "Visibility between VPLs and receivers: traced, shadow_map, imperfect_shadow_map."),
        nested("selection", &S::selection, Category::selection, "all",
               "VPLs that light each receiver: all, uniform, lightcuts, multidimensional_lightcuts, "
               "stochastic_lightcuts, light_tree, resampling, matrix."),
        row("scattering_points", &S::scattering_points, between(0, 64),
            "Points in media where the light of each eye ray is gathered, besides the surface behind them: "
            "less noise of single scattering for more shadow rays; 0: one collision or the surface, by "
            "chance."),
        within(&S::clamping, row("roughness_clamping", &compensation::RoughnessClamping::enabled,
                                 "Widens glossy lobes to the density of the VPLs: biased, removes spikes of "
                                 "glossy surfaces.")),
        row("interleaving", &S::interleaving, between(1, 8),
            "n: a pixel of n x n gathers every n^2-th VPL, which counts n^2 times, in 1 / n^2 of the time; "
            "with a selection the pixels that share VPLs lie n apart."),
        row("upsampling", &S::upsampling, between(1, 8),
            "n: VPLs are gathered at one pixel of n x n, others interpolate pixels of like surfaces or "
            "gather their own: biased between them; not together with interleaving, eye_samples or shadow "
            "maps."),
        row("filter", &S::filters,
            "Denoises the light of VPLs in image space, as far as noise that differs from pixel to pixel "
            "explains its detail: for interleaving."),
        row("eye_samples", &S::eye_samples, between(1, 4096),
            "Eye paths a pixel and pass; VPLs are shared out among them, except with compensation that joins "
            "every receiver to all.")
            .when_absent("4 for 1-to-1 compensation, else 1")};
    return list;
}

/// Options of which not all go together.
lights::GatherOptions gather_options(const VplSettings& s) {
    lights::GatherOptions options{.interleaving = s.interleaving > 1,
                                  .compensation = s.residual->restores(),
                                  .roughness_clamping = s.clamping.enabled};
    s.visibility->declare(options);
    return options;
}

void check(const VplSettings& s, const Properties& properties) {
    const lights::GatherOptions options = gather_options(s);
    if (options.compensation && !s.bounded())
        throw InputError("compensation brings back what a bound takes: bound must not be -1 (no bound)",
                         properties.where_of("bound"));
    if (const std::string against = s.selection->excludes(options); !against.empty())
        throw InputError("a selection of VPLs does not go together with " + against, s.selection->where);
    if (s.upsampling == 1) return;
    const char* against = options.interleaving  ? "interleaving"
                          : s.eye_paths() > 1   ? "eye_samples above 1"
                          : options.shadow_maps ? "shadow maps"
                                                : nullptr;
    if (against)
        throw InputError(std::string("upsampling does not go together with ") + against,
                         properties.where_of("upsampling"));
}

class MoteVpl final : public Integrator {
  public:
    explicit MoteVpl(const VplSettings& settings) : settings_(settings) {}
    std::string type() const override { return "mote_vpl"; }
    bool works_on_mean() const override { return settings_.residual->works_on_mean() || settings_.filters; }
    std::vector<Layer> layers(const Scene& scene) const override {
        auto layers = transport_layers(scene.has_media(), settings_.bounded() ? "_bounded" : "");
        for (Layer& layer : settings_.residual->layers(scene.has_media())) layers.push_back(std::move(layer));
        const bool estimates_missing = scene.film().interval && error_unknown().empty();
        for (Layer& layer : layers)
            layer.squares = settings_.filters && (layer.transport == Transport::indirect ||
                                                  layer.transport == Transport::multiple_scattering);
        if (estimates_missing)
            layers.push_back({.name = "missing",
                              .description = "light that the bound takes, and that comes through mirrors and "
                                             "glass, estimated by paths",
                              .auxiliary = true,
                              .squares = true,
                              .missing = true});
        return layers;
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_vpl_estimator(scene, options, settings_);
    }
    std::unique_ptr<PointLights> point_lights(const Scene& scene,
                                              const RenderOptions& options) const override {
        return make_vpl_point_lights(scene, options, settings_);
    }

  private:
    std::string error_unknown() const;
    void plan_choice_of_vpls(Plan& plan, const Scene& scene, const Requirements& r) const;
    void plan_bound(Plan& plan, const Bounds3& surfaces) const;
    void plan_image_space(Plan& plan) const;
    VplSettings settings_;
};

/// The reason why the passes do not show the error; "" where they do.
std::string MoteVpl::error_unknown() const {
    const VplSettings& s = settings_;
    if (!s.bounded()) return "without a bound the variance of its passes is infinite";
    if (s.residual->restores()) return "compensation has an error of its own";
    if (s.clamping.enabled) return "roughness clamping blurs reflections";
    if (s.upsampling > 1) return "upsampling interpolates between pixels";
    if (s.filters) return "the filter smoothes";
    if (!s.visibility->is_exact()) return "shadow maps have an error of their own";
    if (!s.selection->is_unbiased()) return "the selection of VPLs is biased";
    return "";
}

/// A light path leaves some three VPLs.
void MoteVpl::plan_choice_of_vpls(Plan& plan, const Scene& scene, const Requirements& r) const {
    const double pixels = double(scene.film().width) * double(scene.film().height);
    const double lattice = double(settings_.upsampling * settings_.upsampling);
    const int points = scene.has_media() && settings_.scattering_points > 0
                           ? 1 + std::min(settings_.scattering_points, 2)
                           : 1;
    const GatherSize size{3.0 * double(settings_.paths),
                          pixels * settings_.eye_paths() / lattice,
                          points,
                          settings_.filters,
                          depth_of_media(scene),
                          r.media_heterogeneous == 0};
    settings_.selection->plan(plan, {size.vpls, size.receivers * size.points});
    plan_selection_advice(plan, size);
    if (settings_.selection->takes_all() && settings_.interleaving == 1) warn_of_long_passes(plan, size);
}

void MoteVpl::plan_bound(Plan& plan, const Bounds3& surfaces) const {
    if (!settings_.bounded()) {
        plan.run("bound", "none", "bound is -1: right in the mean, with splotches around VPLs");
        return;
    }
    const float bound = settings_.bound_for(surfaces);
    plan.run("bound", fmt::format("{:f} /m^2, radius {:f} m", bound, 1.0f / std::sqrt(bound)),
             settings_.bound
                 ? "requested"
                 : fmt::format("automatic: light paths / R^2, with R = {:f} m the radius of all shapes",
                               surfaces.radius()));
}

void MoteVpl::plan_image_space(Plan& plan) const {
    const int n = settings_.interleaving;
    if (n > 1 && !settings_.selection->takes_all())
        plan.run("interleaving", fmt::format("the 4 x 4 pixels that share selected VPLs lie {} apart", n),
                 "unbiased: noise differs from pixel to pixel");
    else if (n > 1)
        plan.run("interleaving", fmt::format("{} shares of the VPLs, for pixels of {} x {}", n * n, n, n),
                 "unbiased: noise differs from pixel to pixel, and less work is done");
    if (const int m = settings_.upsampling; m > 1)
        plan.run("upsampling",
                 fmt::format("VPLs at one pixel of {} x {}, between by what neighbours see", m, m),
                 "biased by what light does between them; pixels without a neighbour alike gather their own");
    if (settings_.filters)
        plan.run("filter", "light of VPLs in image space",
                 "biased by what it smoothes, less with every pass. The noise that is stated, and --noise, "
                 "are those of the passes before it");
}

Plan MoteVpl::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.error_unknown = error_unknown(), plan.error_by_groups = plan.error_unknown.empty();
    settings_.light_source(scene)->plan(plan);
    plan_bound(plan, scene.rays().bounds());
    const bool directional = r.any_glossy() || (r.media_anisotropic && r.media_scattering);
    plan.run("light per VPL",
             directional ? "64 bytes, and the vertex where f* depends on direction" : "64 bytes, one colour",
             directional ? "there are glossy surfaces or anisotropic media"
                         : "every surface is diffuse and every medium isotropic");
    const double pixels = double(scene.film().width) * double(scene.film().height);
    settings_.visibility->plan(plan, scene, pixels * settings_.eye_paths());
    plan_choice_of_vpls(plan, scene, r);
    plan_media(plan, r);
    plan_narrow_phases(plan, scene);
    if (r.any_media() && settings_.scattering_points == 0)
        plan.run("eye rays", "one distance by tracking per pixel and pass", "Engelhardt 2013, Eq. 10.9");
    if (r.any_media() && settings_.scattering_points > 0)
        plan.run(
            "eye rays",
            fmt::format("{} scattering points, and the surface behind them", settings_.scattering_points),
            "one walk a pixel and pass; VPLs are shared out among the points");
    settings_.residual->plan(plan, scene, r, settings_.bound_for(scene.rays().bounds()));
    if (settings_.eye_paths() > 1)
        plan.run("eye paths", fmt::format("{} a pixel and pass", settings_.eye_paths()),
                 settings_.vpls_shared_out() ? "VPLs are shared out among them" : "each meets all VPLs");
    plan_image_space(plan);
    if (settings_.clamping.enabled)
        plan.miss("sharp reflections of indirect light", "roughness clamping blurs them",
                  "requested: biased; more passes do not sharpen them, more light paths do");
    if (r.any_delta())
        plan.miss("caustics", "light that reaches a receiver through a delta surface",
                  "a VPL cannot be connected through mirrors and glass; volpath renders it");
    plan_choice_of_lights(plan, scene);
    plan_medium_lights(plan, r);
    return plan;
}

}  // namespace

std::shared_ptr<const Integrator> make_sampled_vpls(const EyePathLimits& limits) {
    VplSettings s;
    s.eye = limits, s.eye.max_scatterings = 1;
    s.paths = 20000, s.scattering_points = 1, s.interleaving = 4;
    s.selection = lights::resampled_vpls(256, 16);
    return std::make_shared<MoteVpl>(s);
}

void register_mote_vpl(Registry& registry) {
    add_type(registry, Category::integrator, "mote_vpl",
             "Virtual point lights on surfaces and in media, with a bounded geometry term.", vpl_rows(),
             R"(<integrator type="mote_vpl"><integer name="paths" value="512"/></integrator>)",
             [](VplFile file, const Properties& properties) {
                 check(file, properties);
                 return std::make_shared<MoteVpl>(file);
             });
}

}  // namespace mote::integrators
