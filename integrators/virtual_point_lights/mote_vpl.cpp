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
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/eye_path/transport_layers.h"
#include "integrators/register_parts.h"
#include "integrators/virtual_point_lights/plan_compensation.h"
#include "integrators/virtual_point_lights/plan_selection.h"
#include "integrators/virtual_point_lights/vpl_estimator.h"
#include "lights/reflective_shadow_maps/reflective_shadow_maps.h"
#include "lights/selection/resampling/resampling_selection.h"

namespace mote::integrators {

using namespace core;
namespace {

class MoteVpl final : public Integrator {
  public:
    explicit MoteVpl(const VplSettings& settings) : settings_(settings) {}
    explicit MoteVpl(const Properties& properties) {
        settings_.eye = eye_path_rows().read(properties);
        settings_.eye.max_scatterings = 1;  // from then on virtual lights take over
        const auto paths = properties.get_int("paths", 256);
        if (paths < 0 || paths > (std::int64_t(1) << 26))
            throw InputError("paths must lie between 0 and 2^26", properties.where_of("paths"));
        settings_.paths = std::uint32_t(paths);
        settings_.bounded = properties.get_bool("bounded", true);
        if (properties.has("bound")) {
            const double bound = properties.require_float("bound");
            if (!(bound > 0.0) || !std::isfinite(float(bound)))
                throw InputError("bound must be positive and finite; bounded=false renders without a bound",
                                 properties.where_of("bound"));
            settings_.bound = float(bound);
            if (!settings_.bounded) properties.warn("bound has no effect: bounded is false");
        }
        read_compensation(properties);
        settings_.scattering_points =
            int(properties.get_int_in("scattering_points", settings_.scattering_points, 0, 64));
        settings_.reflective_maps = int(properties.get_int_in("reflective_shadow_maps", 0, 0, 2048));
        settings_.interleaving = int(properties.get_int_in("interleaving", 1, 1, 8));
        settings_.upsampling = int(properties.get_int_in("upsampling", 1, 1, 8));
        settings_.clamping.enabled = properties.get_bool("roughness_clamping", false);
        settings_.filters = properties.get_bool("filter", false);
        if (const auto nested = properties.child_of<Visibility>(Category::visibility))
            settings_.visibility = nested->settings();
        if (const auto nested = properties.child_of<lights::Selection>(Category::selection))
            settings_.selection = nested;
        check_selection();
        if (settings_.upsampling > 1) check_upsampling(properties);
    }

    std::string type() const override { return "mote_vpl"; }
    bool works_on_mean() const override { return settings_.screen_space.has_value() || settings_.filters; }
    std::vector<Layer> layers(const Scene& scene) const override {
        auto layers = transport_layers(scene.has_media(), settings_.bounded ? "_bounded" : "");
        if (settings_.compensates()) add_compensation_layers(scene, layers);
        for (Layer& layer : layers)
            layer.squares = settings_.filters && (layer.transport == Transport::indirect ||
                                                  layer.transport == Transport::multiple_scattering);
        return layers;
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_vpl_estimator(scene, options, settings_);
    }

  private:
    void add_compensation_layers(const Scene& scene, std::vector<Layer>& layers) const {
        layers.push_back(
            {"compensation_surface", "what the bound took from light first scattered by a surface"});
        layers.back().transport = Transport::indirect;
        if (scene.has_media()) {
            layers.push_back(
                {"compensation_volume", "what the bound took from light first scattered in a medium"});
            layers.back().transport = Transport::multiple_scattering;
        }
        if (settings_.screen_space)
            for (Layer& layer : settings_.screen_space->film_layers()) layers.push_back(std::move(layer));
    }
    void read_compensation(const Properties& properties);
    void check_upsampling(const Properties& properties) const;
    void check_selection() const;
    void plan_choice_of_vpls(Plan& plan, const Scene& scene, const Requirements& r) const;
    void plan_bound(Plan& plan, const Bounds3& surfaces) const;
    void plan_light_paths(Plan& plan, const Scene& scene) const;
    void plan_image_space(Plan& plan) const;
    VplSettings settings_;
};

void MoteVpl::read_compensation(const Properties& properties) {
    const auto nested = properties.child_of<Object>(Category::compensation);
    if (const auto inside = std::dynamic_pointer_cast<compensation::Compensation>(nested))
        settings_.compensation = inside->settings();
    if (const auto after = std::dynamic_pointer_cast<ScreenSpaceCompensation>(nested))
        settings_.screen_space = after->settings(), settings_.compensation = after->media();
    if (settings_.compensates() && !settings_.bounded)
        throw InputError("compensation brings back what a bound takes: it needs bounded=true",
                         properties.where_of("bounded"));
    const bool one_to_one = settings_.compensation.enabled && settings_.vpls_shared_out();
    settings_.eye_samples = int(properties.get_int_in("eye_samples", one_to_one ? 4 : 1, 1, 4096));
}

void MoteVpl::check_upsampling(const Properties& properties) const {
    const char* against = settings_.interleaving > 1         ? "interleaving"
                          : settings_.eye_samples > 1        ? "eye_samples above 1"
                          : settings_.visibility.shadow_maps ? "shadow maps"
                                                             : nullptr;
    if (against)
        throw InputError(std::string("upsampling does not go together with ") + against,
                         properties.where_of("upsampling"));
}

void MoteVpl::check_selection() const {
    const lights::Selection& s = *settings_.selection;
    if (s.takes_all()) return;
    const char* against = settings_.interleaving > 1 && !s.interleaves() ? "interleaving"
                          : settings_.compensates()                      ? "compensation"
                          : settings_.clamping.enabled                   ? "roughness_clamping"
                          : settings_.visibility.shadow_maps             ? "shadow maps"
                          : settings_.visibility.imperfect && s.traces() ? "imperfect shadow maps"
                                                                         : nullptr;
    if (against)
        throw InputError(std::string("a selection of VPLs does not go together with ") + against, s.where);
}

/// A light path leaves some three VPLs.
void MoteVpl::plan_choice_of_vpls(Plan& plan, const Scene& scene, const Requirements& r) const {
    const double pixels = double(scene.film().width) * double(scene.film().height);
    const double lattice = double(settings_.upsampling * settings_.upsampling);
    const int points = scene.has_media() && settings_.scattering_points > 0
                           ? 1 + std::min(settings_.scattering_points, 2)
                           : 1;
    const GatherSize size{3.0 * double(settings_.paths),
                          pixels * settings_.eye_samples / lattice,
                          points,
                          settings_.filters,
                          depth_of_media(scene),
                          r.media_heterogeneous == 0};
    settings_.selection->plan(plan, {size.vpls, size.receivers * size.points});
    plan_selection_advice(plan, size);
}

void MoteVpl::plan_light_paths(Plan& plan, const Scene& scene) const {
    std::uint32_t paths = settings_.paths;
    if (const int size = settings_.reflective_maps; size > 0) {
        const lights::ReflectiveShadowMaps maps(scene, size, settings_.paths);
        paths = maps.paths();
        plan.run("reflective shadow maps",
                 std::to_string(maps.maps()) + " of " + std::to_string(size) + "^2 texels",
                 maps.maps() > 0 ? "each texel begins a light path, its flux is intensity times solid angle"
                                 : "no light is a point, a cone or parallel");
    }
    plan.run("light paths", std::to_string(paths) + " a pass", "a fresh set every pass");
}

void MoteVpl::plan_bound(Plan& plan, const Bounds3& surfaces) const {
    if (!settings_.bounded) {
        plan.run("bound", "none", "bounded is false: right in the mean, with splotches around VPLs");
        return;
    }
    const float bound = settings_.bound_for(surfaces);
    const std::string choice =
        std::to_string(bound) + " /m^2, radius " + std::to_string(1.0f / std::sqrt(bound)) + " m";
    plan.run("bound", choice,
             settings_.bound ? "asked for"
                             : "automatic: light paths / R^2, with R = " + std::to_string(surfaces.radius()) +
                                   " m the radius of all shapes");
}

void MoteVpl::plan_image_space(Plan& plan) const {
    const int n = settings_.interleaving;
    if (n > 1 && !settings_.selection->takes_all())
        plan.run("interleaving",
                 "the 4 x 4 pixels that share selected VPLs lie " + std::to_string(n) + " apart",
                 "unbiased: noise differs from pixel to pixel");
    else if (n > 1)
        plan.run("interleaving",
                 std::to_string(n * n) + " shares of the VPLs, for pixels of " + std::to_string(n) + " x " +
                     std::to_string(n),
                 "unbiased: noise differs from pixel to pixel, and less work is done");
    if (const int m = settings_.upsampling; m > 1)
        plan.run("upsampling",
                 "VPLs at one pixel of " + std::to_string(m) + " x " + std::to_string(m) +
                     ", between by what neighbours see",
                 "biased by what light does between them; pixels without a neighbour alike gather their own");
    if (settings_.filters)
        plan.run("filter", "light of VPLs in image space",
                 "biased by what it smoothes, less with every pass. The noise that is stated, and --noise, "
                 "are those of "
                 "the passes before it");
}

Plan MoteVpl::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan_light_paths(plan, scene);
    plan_bound(plan, scene.rays().bounds());
    const bool directional = r.any_glossy() || (r.media_anisotropic && r.media_scattering);
    if (directional)
        plan.run("light per VPL", "64 bytes, and the vertex where f* depends on direction",
                 "there are glossy surfaces or anisotropic media");
    else
        plan.run("light per VPL", "64 bytes, one colour",
                 "every surface is diffuse and every medium isotropic");
    const double pixels = double(scene.film().width) * double(scene.film().height);
    plan_visibility(plan, scene, settings_.visibility, pixels * settings_.eye_samples);
    plan_choice_of_vpls(plan, scene, r);
    plan_media(plan, r);
    plan_narrow_phases(plan, scene);
    if (r.any_media() && settings_.scattering_points == 0)
        plan.run("eye rays", "one distance by tracking per pixel and pass", "Engelhardt 2013, Eq. 10.9");
    if (r.any_media() && settings_.scattering_points > 0)
        plan.run(
            "eye rays",
            std::to_string(settings_.scattering_points) + " scattering points, and the surface behind them",
            "one walk a pixel and pass; VPLs are shared out among the points");
    if (settings_.bounded && !settings_.compensates())
        plan.miss("short distances", "light between points closer than the bound's radius is darkened",
                  "the bound removes it; <compensation> brings it back");
    if (settings_.screen_space) plan_screen_space(plan, r, *settings_.screen_space);
    if (settings_.compensation.enabled)
        plan_compensation(plan, scene, r, settings_.compensation, settings_.bound_for(scene.rays().bounds()));
    if (settings_.bounded)
        plan_expected_loss(plan, scene, settings_.compensation, settings_.bound_for(scene.rays().bounds()));
    if (settings_.eye_samples > 1)
        plan.run("eye paths", std::to_string(settings_.eye_samples) + " a pixel and pass",
                 settings_.vpls_shared_out() ? "VPLs are shared out among them" : "each meets all VPLs");
    plan_image_space(plan);
    if (settings_.clamping.enabled)
        plan.miss("sharp reflections of indirect light", "roughness clamping blurs them",
                  "asked for: biased; more passes do not sharpen them, more light paths do");
    if (r.any_delta())
        plan.miss("caustics", "light that reaches a receiver through a delta surface",
                  "a VPL cannot be connected through mirrors and glass; volpath renders it");
    plan_choice_of_lights(plan, scene);
    plan_medium_lights(plan, r);
    return plan;
}

}  // namespace

std::shared_ptr<const Integrator> make_drawn_vpls(const EyePathLimits& limits) {
    VplSettings s;
    s.eye = limits, s.eye.max_scatterings = 1;
    s.paths = 20000, s.scattering_points = 1, s.interleaving = 4;
    s.selection = std::make_shared<lights::ResamplingSelection>(256, 16);
    return std::make_shared<MoteVpl>(s);
}

void register_mote_vpl(Registry& registry) {
    auto parameters = eye_path_rows().parameters();
    parameters.push_back(
        {"paths", "integer", "256",
         "light paths traced in every pass, some three VPLs each: time without a selection is in "
         "proportion, and the automatic bound removes less energy"});
    parameters.push_back(
        {"reflective_shadow_maps", "integer", "0",
         "texels along an edge of the map of each point, spot and directional light, up to 2048: each "
         "begins a light path, spread more evenly than sampled ones, and `paths` are those of other "
         "lights; 0: all lights sample their paths"});
    parameters.push_back(
        {"bound", "float", "automatic",
         "bound b [1/m^2] on the geometry term; lower: less noise, and more energy is removed; "
         "automatic: light paths / R^2 with the radius R of all shapes"});
    parameters.push_back({"bounded", "boolean", "true",
                          "false: no bound on the geometry term, unbiased with infinite variance near VPLs"});
    parameters.push_back(
        {"compensation", "compensation", "none", "method that restores the energy that the bound removes"});
    parameters.push_back({"visibility", "visibility", "traced",
                          "visibility between VPLs and receivers: traced, shadow_map, imperfect_shadow_map"});
    parameters.push_back({"selection", "selection", "all",
                          "VPLs that light each receiver: all, lightcuts, multidimensional_lightcuts, "
                          "stochastic_lightcuts, light_tree, resampling, matrix"});
    parameters.push_back(
        {"scattering_points", "integer", "8",
         "points in media where the light of each eye ray is gathered, besides the surface behind them, up "
         "to 64: less noise of single scattering for more shadow rays; 0: one collision or the surface, by "
         "chance"});
    parameters.push_back(
        {"roughness_clamping", "boolean", "false",
         "widen glossy lobes to the density of the VPLs: biased, removes spikes of glossy surfaces"});
    parameters.push_back(
        {"interleaving", "integer", "1",
         "n, up to 8: a pixel of n x n gathers every n^2-th VPL, which counts n^2 times, in 1 / n^2 of the "
         "time; with a selection the pixels that share VPLs lie n apart"});
    parameters.push_back(
        {"upsampling", "integer", "1",
         "n, up to 8: VPLs are gathered at one pixel of n x n, others interpolate pixels of like surfaces "
         "or gather their own: biased between them; not together with interleaving, eye_samples or shadow "
         "maps"});
    parameters.push_back(
        {"filter", "boolean", "false",
         "denoise the light of VPLs in image space, as far as noise that differs from pixel to pixel "
         "explains its detail: for interleaving"});
    parameters.push_back(
        {"eye_samples", "integer", "4 for 1-to-1 compensation, else 1",
         "eye paths a pixel and pass; VPLs are shared out among them, except with compensation that joins "
         "every receiver to all"});
    registry.add({Category::integrator, "mote_vpl",
                  "Virtual point lights on surfaces and in media, with a bounded geometry term.", parameters,
                  R"(<integrator type="mote_vpl"><integer name="paths" value="512"/></integrator>)"},
                 [](const Properties& p) { return std::make_shared<MoteVpl>(p); });
}

}  // namespace mote::integrators
