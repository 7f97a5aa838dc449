// The passes of `mote_photon_map`.
#pragma once

#include "gathering/photon_maps/progressive_radius.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/photon_map/photon_eye_path.h"
#include "integrators/photon_map/photon_map_settings.h"

namespace mote::integrators {

/// The photons p of a pass, of flux Phi_p, give a receiver on a surface, and an eye ray in media,
///   L = sum over p of f*(wo, w_p) Phi_p / (pi r^2)                   (Engelhardt 2013, Eq. 4.5)
///   L = sum over p of tau(0, t_p) f_p(wo, w_p) Phi_p / (pi r_p^2)    (Jarosz et al. 2008)
/// with radii r that shrink from pass to pass (gathering/photon_maps/progressive_radius.h).
template <bool Media>
class PhotonMapEstimator : public core::Estimator {
  public:
    PhotonMapEstimator(const core::Scene& scene, const core::RenderOptions& options,
                       const PhotonMapSettings& settings)
        : scene_(scene), options_(options), settings_(settings), loop_(scene, options, {.by_rows = true}) {
        settings_.eye.wanted = options.cells;
    }

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        if (context.cancelled) return false;
        const PhotonMaps maps = make_maps(context.index, context.cancelled);
        return loop_.run(context, image, {}, [&](EyeTask<Media>& task) {
            PhotonScratch scratch;
            PhotonEyePath<Media> path(scene_, settings_.eye, maps, task.walk(), scratch);
            task.trace_each([&](const EyeRay& eye) { return path.trace(eye); });
        });
    }

    void add_statistics(core::Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["photons_on_surfaces"] += double(on_surfaces_);
        statistics.values["photons_in_media"] += double(in_media_);
        statistics.values["photons_before_thinning"] += double(met_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["photon_bytes_peak"] = double(bytes_);
        statistics.values["kernel_radius_share"] = radius_fraction_;
    }

  protected:
    PhotonMaps make_maps(std::uint32_t pass, core::CancelToken cancelled) {
        gathering::PhotonSet set = gathering::trace_photons(scene_, settings_.photons(options_.memory),
                                                            options_.seed, pass, options_.sampler, cancelled);
        loop_.counters().add(set.rays, set.tracking);
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

    const core::Scene& scene_;
    core::RenderOptions options_;
    PhotonMapSettings settings_;
    ImageLoop<Media> loop_;
    std::uint64_t on_surfaces_ = 0, in_media_ = 0, met_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
    double radius_fraction_ = 1.0;
};

}  // namespace mote::integrators
