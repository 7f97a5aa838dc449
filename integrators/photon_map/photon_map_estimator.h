// The passes of `mote_photon_map`.
#pragma once

#include "gathering/photon_maps/photon_tracer.h"
#include "gathering/photon_maps/progressive_radius.h"
#include "integrators/eye_path/counters.h"
#include "integrators/photon_map/photon_eye_path.h"

namespace mote::integrators {

/// Settings of `mote_photon_map`.
struct PhotonMapSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 100000;
    std::size_t neighbours = 50, max_photons = std::size_t(1) << 23;
    double alpha = 2.0 / 3.0;
    bool single_scattering = false;

    gathering::PhotonSettings photons(const core::MemoryBudget& memory) const {
        gathering::PhotonSettings s;
        s.paths.memory = memory, s.paths.paths = paths, s.paths.rr_depth = eye.rr_depth;
        s.paths.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 1);
        s.first_in_medium = single_scattering ? 1 : 2;
        s.max_photons = max_photons;
        return s;
    }
};

/// The passes: a fresh set of photons each.
template <bool Media>
class PhotonMapEstimator : public core::Estimator {
  public:
    PhotonMapEstimator(const core::Scene& scene, const core::RenderOptions& options,
                       const PhotonMapSettings& settings)
        : scene_(scene), options_(options), settings_(settings) {
        settings_.eye.wanted = options.cells;
    }

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        if (context.cancelled) return false;
        const PhotonMaps maps = make_maps(context.index, context.cancelled);
        return core::for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                                   [&](int x0, int y0, int x1, int y1) {
                                       core::WalkContext walk;
                                       walk.cancelled = context.cancelled;
                                       PhotonScratch scratch;
                                       PhotonEyePath<Media> path(scene_, settings_.eye, maps, walk, scratch);
                                       for (int y = y0; y < y1; ++y)
                                           for (int x = x0; x < x1; ++x) {
                                               if (context.cancelled) return;
                                               const EyeRay eye =
                                                   make_eye_ray(scene_, options_, context, x, y);
                                               walk.rng = eye.rng;
                                               store(path.trace(eye), image, x, y, Media);
                                           }
                                       counters_.add(walk.rays, walk.tracking);
                                   });
    }

    void add_statistics(core::Statistics& statistics) const override {
        counters_.report(statistics, Media);
        statistics.values["photons_on_surfaces"] += double(on_surfaces_);
        statistics.values["photons_in_media"] += double(in_media_);
        statistics.values["photons_before_thinning"] += double(met_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["photon_bytes_peak"] = double(bytes_);
        statistics.values["kernel_radius_share"] = radius_fraction_;
    }

  protected:
    static constexpr int tile_size = 16;

    PhotonMaps make_maps(std::uint32_t pass, core::CancelToken cancelled) {
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

    const core::Scene& scene_;
    core::RenderOptions options_;
    PhotonMapSettings settings_;
    SharedCounters counters_;
    std::uint64_t on_surfaces_ = 0, in_media_ = 0, met_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
    double radius_fraction_ = 1.0;
};

/// The photons of its passes.
std::unique_ptr<core::PointLights> make_photon_point_lights(const core::Scene& scene,
                                                            const core::RenderOptions& options,
                                                            const PhotonMapSettings& settings);

}  // namespace mote::integrators
