#include "integrators/ray_lights/ray_light_settings.h"
#include "integrators/ray_lights/ray_light_tile.h"

namespace mote::integrators {

using namespace core;

namespace {

/// With P_j the power of ray light j, L_k the light of VPL k on a surface and q = T sigma_s f_p along a line,
/// an eye ray of length s and the surface x at its end get
///   sum_j P_j int_0^s int q(t) G* V* q(u) du dt  +  sum_k L_k int_0^s q(t) G* V* dt,
///   sum_j P_j int f*(x) G* V* q(u) du  +  sum_k L_k f*(x) min(G*, b) V*  +  what the bound b took
/// (Novak et al. 2012); ray_light_tile.h samples j, k, u and t.
template <bool Media>
class RayLightEstimator final : public Estimator {
  public:
    RayLightEstimator(const Scene& scene, const RenderOptions& options, const RayLightSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          loop_(scene, options),
          bound_(settings.bound_for(scene.rays().bounds())),
          media_(scene.media()) {
        settings_.eye.wanted = options.cells;
        settings_.eye.max_scatterings = std::isfinite(bound_) ? -1 : 1;
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const lights::RayLightSet set =
            lights::trace_ray_lights(scene_, media_, settings_.light_paths(options_.memory), options_.seed,
                                     context.index, options_.sampler, context.cancelled);
        loop_.counters().add(set.surface.rays, set.surface.tracking);
        rays_ += set.rays.size(), vpls_ += set.surface.lights.size(), paths_ += settings_.paths;
        bytes_ = std::max(bytes_, set.memory_bytes());
        const RayLightPass lights{media_, set, bound_};
        const EyePacketSettings eye{.limits = settings_.eye, .scattering_points = scattering_points()};
        return loop_.run(context, image, eye, [&](EyeTask<Media>& task) {
            RayLightTile<Media> tile(scene_, settings_, lights, task.packet());
            task.for_each([&](const PacketPixels&) { tile.run(); });
            const std::lock_guard lock(mutex_);
            pairs_.add(tile.counters());
        });
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["ray_lights"] += double(rays_);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["light_bytes_peak"] = double(bytes_);
        statistics.values["line_pairs"] += double(pairs_.pairs);
        statistics.values["line_pairs_connected"] += double(pairs_.connected);
        if (std::isfinite(bound_)) statistics.values["bound"] = bound_;
    }

  private:
    int scattering_points() const {
        return settings_.eye.wanted[Transport::single_scattering] ? settings_.scattering_points : 0;
    }

    const Scene& scene_;
    RenderOptions options_;
    RayLightSettings settings_;
    ImageLoop<Media> loop_;
    float bound_;
    lights::ScatteringMedia media_;
    std::mutex mutex_;
    lights::LineCounters pairs_;
    std::uint64_t rays_ = 0, vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<Estimator> make_ray_light_estimator(const Scene& scene, const RenderOptions& options,
                                                    const RayLightSettings& settings) {
    if (scene.has_media()) return std::make_unique<RayLightEstimator<true>>(scene, options, settings);
    return std::make_unique<RayLightEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
