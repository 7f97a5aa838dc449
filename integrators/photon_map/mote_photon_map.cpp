// `mote_photon_map`: photon mapping with radiance estimates at the first vertex, and beams through media.
//
// Every pass traces a fresh set of photons, on surfaces (Jensen 2001) and in media, where the eye ray meets
// them as discs (the beam radiance estimate, Jarosz et al. 2008). Kernels hold the k nearest photons in the
// first pass and shrink from pass to pass (Knaus & Zwicker 2011), so that the mean over passes converges to
// the true picture: biased after any number of passes, unbiased in the limit. Direct light, and single
// scattering unless it is estimated by photons, are sampled as in `mote_vpl`.
#include <fmt/format.h>

#include "gathering/photon_maps/photon_tracer.h"
#include "gathering/photon_maps/progressive_radius.h"
#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/eye_path/plan_narrow_phases.h"
#include "integrators/photon_map/photon_eye_path.h"
#include "integrators/register_parts.h"

namespace mote::integrators {

using namespace core;

namespace {

struct PhotonMapSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 100000;
    std::size_t neighbours = 50, max_photons = std::size_t(1) << 23;
    double alpha = 2.0 / 3.0;
    bool single_scattering = false;

    gathering::PhotonSettings photons(const MemoryBudget& memory) const {
        gathering::PhotonSettings s;
        s.paths.memory = memory, s.paths.paths = paths, s.paths.rr_depth = eye.rr_depth;
        s.paths.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 1);
        s.first_in_medium = single_scattering ? 1 : 2;
        s.max_photons = max_photons;
        return s;
    }
};

template <bool Media>
class PhotonMapEstimator final : public Estimator {
  public:
    PhotonMapEstimator(const Scene& scene, const RenderOptions& options, const PhotonMapSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {
        settings_.eye.wanted = options.cells;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const PhotonMaps maps = make_maps(context.index, context.cancelled);
        return for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                             [&](int x0, int y0, int x1, int y1) {
                                 WalkContext walk;
                                 walk.cancelled = context.cancelled;
                                 PhotonScratch scratch;
                                 PhotonEyePath<Media> path(scene_, settings_.eye, maps, walk, scratch);
                                 for (int y = y0; y < y1; ++y)
                                     for (int x = x0; x < x1; ++x) {
                                         if (context.cancelled) return;
                                         const EyeRay eye = make_eye_ray(scene_, options_, context, x, y);
                                         walk.rng = eye.rng;
                                         store(path.trace(eye), image, x, y, Media);
                                     }
                                 counters_.add(walk.rays, walk.tracking);
                             });
    }

    void add_statistics(Statistics& statistics) const override {
        counters_.report(statistics, Media);
        statistics.values["photons_on_surfaces"] += double(on_surfaces_);
        statistics.values["photons_in_media"] += double(in_media_);
        statistics.values["photons_before_thinning"] += double(met_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["photon_bytes_peak"] = double(bytes_);
        statistics.values["kernel_radius_share"] = radius_fraction_;
    }

  private:
    static constexpr int tile_size = 16;

    PhotonMaps make_maps(std::uint32_t pass, CancelToken cancelled) {
        gathering::PhotonSet set = gathering::trace_photons(scene_, settings_.photons(options_.memory),
                                                            options_.seed, pass, options_.sampler, cancelled);
        counters_.add(set.rays, set.tracking);
        paths_ += settings_.paths, met_ += set.met;
        on_surfaces_ += set.surface.size(), in_media_ += set.volume.size();
        radius_fraction_ = gathering::radius_fraction(pass, settings_.alpha);
        PhotonMaps maps;
        maps.estimate = {settings_.neighbours, float(radius_fraction_)};
        maps.single_scattering = settings_.single_scattering;
        maps.surface = gathering::SurfacePhotonMap(std::move(set.surface));
        const float scene_radius = scene_.bounds().radius();
        if constexpr (Media)
            maps.volume = gathering::VolumePhotonMap(scene_, std::move(set.volume), maps.estimate,
                                                     scene_radius > 0.0f ? scene_radius : 1.0f);
        bytes_ = std::max(bytes_, maps.surface.memory_bytes() + maps.volume.memory_bytes());
        return maps;
    }

    const Scene& scene_;
    RenderOptions options_;
    PhotonMapSettings settings_;
    SharedCounters counters_;
    std::uint64_t on_surfaces_ = 0, in_media_ = 0, met_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
    double radius_fraction_ = 1.0;
};

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
    std::unique_ptr<Estimator> prepare(const Scene& scene, const RenderOptions& options) const override {
        if (scene.has_media()) return std::make_unique<PhotonMapEstimator<true>>(scene, options, settings_);
        return std::make_unique<PhotonMapEstimator<false>>(scene, options, settings_);
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
        plan.run("single scattering",
                 settings_.single_scattering ? "from photons" : "sampled at one collision of every ray",
                 settings_.single_scattering ? "requested" : "single_scattering is 'sampled'");
    }
    plan.run("kernels", fmt::format("radii shrink with alpha = {:.3g}", settings_.alpha),
             settings_.alpha < 1.0 ? "bias and noise of the mean both go to zero with the number of passes"
                                   : "alpha is 1: they do not shrink, and the bias stays");
    plan_choice_of_lights(plan, scene);
    plan_medium_lights(plan, r);
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
