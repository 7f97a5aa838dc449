// `mote_photon_map`: photon mapping with radiance estimates at the first vertex, and beams through media.
//
// Every pass traces a fresh set of photons, on surfaces (Jensen 2001) and in media, where the eye ray meets
// them as discs (the beam radiance estimate, Jarosz et al. 2008). Kernels hold the k nearest photons in the
// first pass and shrink from pass to pass (Knaus & Zwicker 2011), so that the mean over passes converges to
// the true picture: biased after any number of passes, unbiased in the limit. Direct light, and single
// scattering unless it is estimated by photons, are sampled as in `mote_vpl`.
#include <fmt/format.h>

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/path_tracing/unbiased_paths.h"
#include "integrators/photon_map/photon_map_settings.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

class MotePhotonMap final : public Integrator {
  public:
    explicit MotePhotonMap(const PhotonMapSettings& settings) : settings_(settings) {
        settings_.eye.max_scatterings = 1;  // from then on photons take over
    }

    std::string type() const override { return "mote_photon_map"; }
    std::vector<Layer> layers(const Scene& scene) const override {
        return transport_layers(scene.has_media());
    }
    Plan plan(const Scene& scene, const Requirements& requirements) const override;
    std::shared_ptr<const Integrator> control(const Scene& scene) const override {
        return unbiased_paths(scene, settings_.eye);
    }
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        return make_photon_map_estimator(scene, options, settings_);
    }
    std::unique_ptr<PointLights> point_lights(const Scene& scene,
                                              const RenderOptions& options) const override {
        return make_photon_point_lights(scene, options, settings_);
    }

  private:
    PhotonMapSettings settings_;
};

Plan MotePhotonMap::plan(const Scene& scene, const Requirements& r) const {
    Plan plan;
    plan.integrator = type();
    plan.run("light paths", fmt::format("{} a pass", settings_.paths), "a fresh set every pass");
    plan.run(
        "photons",
        fmt::format("{} bytes each, at most about {} kept", sizeof(gathering::Photon), settings_.max_photons),
        "and 13 bytes of kd-tree on surfaces, 16 bytes of disc and Embree's tree in media; what would be "
        "more is thinned out at random");
    plan.run("surfaces", fmt::format("radiance estimate from the {} nearest photons", settings_.neighbours),
             "at the first vertex that is no mirror and no glass");
    plan_media(plan, r);
    plan_narrow_phases(plan, scene);
    if (r.media_scattering) {
        plan.run("multiple scattering", "beam radiance estimate: photons as discs that face the eye ray",
                 "one walk of the transmittance serves all photons of a ray");
        plan.run("boundaries of media", "discs reach across them",
                 "until kernels have shrunk, light lies beside media, most where they are thin or dense");
        plan.run("single scattering",
                 settings_.single_scattering ? "from photons" : "sampled at one collision of every ray",
                 settings_.single_scattering ? "requested" : "single_scattering is 'sampled'");
    }
    plan.run("kernels", fmt::format("radii shrink with alpha = {:.3g}", settings_.alpha),
             settings_.alpha < 1.0 ? "bias and noise of the mean both go to zero with the number of passes"
                                   : "alpha is 1: they do not shrink, and the bias stays");
    plan_choice_of_lights(plan, scene);
    plan_medium_lights(plan, r);
    plan_control(plan, scene, r, settings_.eye);
    return plan;
}

}  // namespace

void register_mote_photon_map(Registry& registry) {
    using S = PhotonMapSettings;
    add_type<S>(
        registry, Category::integrator, "mote_photon_map",
        "Progressive photon mapping on surfaces, with the beam radiance estimate in media.",
        {within(&S::eye, eye_path_rows()),
         row("photon_paths", &S::paths, between(1, 1 << 26), "Light paths traced in every pass."),
         row("neighbours", &S::neighbours, between(2, 1 << 16),
             "Photons that an estimate of the first pass holds."),
         row("alpha", &S::alpha, above(0).up_to(1),
             "How fast kernels shrink: their area falls as passes^(alpha - 1); 1: not at all."),
         row("single_scattering", &S::single_scattering, {{"sampled", false}, {"photons", true}},
             "Light scattered once in a medium: sampled at collisions, or from photons."),
         row("max_photons", &S::max_photons, between(1, std::ldexp(1.0, 31)),
             "More photons than this in a pass are thinned out, without bias.")},
        R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="50000"/></integrator>)",
        [](const S& s) { return std::make_shared<MotePhotonMap>(s); });
}

}  // namespace mote::integrators
