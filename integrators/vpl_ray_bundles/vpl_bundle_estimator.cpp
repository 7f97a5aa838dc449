#include <mutex>

#include "integrators/layer_filter/layer_filter.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_tile.h"

namespace mote::integrators {

using namespace core;
namespace {

/// Eye paths a pixel and pass: those after the first are for direct light.
int eye_paths(const VplBundleSettings& settings, TransportSet wanted) {
    return wanted[Transport::direct] || wanted[Transport::emission] ? settings.direct_paths() : 1;
}

std::vector<LayerFilter::Choice> filtered_layers(const VplBundleSettings& settings) {
    if (!settings.filters) return {};
    return {{std::size_t(Transport::indirect), screenspace::LayerKind::surface}};
}

/// With the VPLs j of a pass, of light L_j, and the points y that rays of the pass's directions k find, of
/// the density p, a receiver x gets
///   L(x) = sum_j w_j f*(x) G*(x, y_j) V L_j  +  sum_k w_k f(x, w_k) cos(w_k) L(y_k) / p(w_k)
/// (Tokuyoshi & Ogaki 2012, Eqs. 3 and 7) with MIS weights w (gathering/eye_bundles/path_weights.h).
class VplBundleEstimator final : public Estimator {
  public:
    VplBundleEstimator(const Scene& scene, const RenderOptions& options, const VplBundleSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          loop_(scene, options,
                {.interleaving = settings.interleaving, .eye_samples = eye_paths(settings, options.cells)}),
          filter_(scene, options, {}, filtered_layers(settings)) {
        settings_.eye.wanted = options.cells;
        settings_.sky = settings_.sky && settings_.has_bundles() && scene.environment();
        if (settings_.imperfect_links && settings_.has_bundles())
            links_ = std::make_unique<gathering::ImperfectLinks>(
                scene.shapes(),
                gathering::ImperfectLinkSettings{.memory_budget = options.memory.at_most(
                                                     gathering::ImperfectLinkSettings().memory_budget)});
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const double begin = process_cpu_seconds();
        const VplBundlePass pass(scene_, settings_, links_.get(), options_, context);
        light_seconds_ += process_cpu_seconds() - begin;
        loop_.counters().add(pass.vpls.rays, pass.vpls.tracking);
        vpls_ += pass.vpls.lights.size(), paths_ += pass.vpls.paths;
        bytes_ = std::max(bytes_,
                          pass.vpls.memory_bytes() + pass.rivals.size() * sizeof(float) + pass.kept_bytes());
        const EyePacketSettings eye{.limits = settings_.eye, .lights = pass.eye_lights()};
        return loop_.run(context, image, eye, [&](EyeTask<false>& task) {
            VplBundleTile tile(settings_, pass, task.packet());
            task.for_each([&](const PacketPixels& pixels) { tile.run(pixels); },
                          [&](const PacketPixels& pixels) { tile.add_gathered(pixels, image); });
            const std::lock_guard lock(time_mutex_);
            const VplBundleTime& time = tile.time();
            time_.eye += time.eye, time_.vpls += time.vpls, time_.bundles += time.bundles;
        });
    }

    void finish(Film& film, CancelToken cancelled) override { filter_.apply(film, cancelled); }
    double seconds_once() const override { return filter_.feature_seconds(); }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        // Table 1 of the paper.
        statistics.values["light_path_cpu_seconds"] += light_seconds_;
        statistics.values["eye_path_cpu_seconds"] += time_.eye;
        statistics.values["vpl_cpu_seconds"] += time_.vpls;
        statistics.values["bundle_cpu_seconds"] += time_.bundles;
        filter_.add_statistics(statistics);
    }

  private:
    const Scene& scene_;
    RenderOptions options_;
    VplBundleSettings settings_;
    ImageLoop<false> loop_;
    std::unique_ptr<const gathering::ImperfectLinks> links_;  ///< null: rays are traced
    LayerFilter filter_;
    std::mutex time_mutex_;
    VplBundleTime time_;
    double light_seconds_ = 0.0;
    std::uint64_t vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<Estimator> make_vpl_bundle_estimator(const Scene& scene, const RenderOptions& options,
                                                     const VplBundleSettings& settings) {
    return std::make_unique<VplBundleEstimator>(scene, options, settings);
}

}  // namespace mote::integrators
