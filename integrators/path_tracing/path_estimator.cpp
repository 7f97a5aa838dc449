#include "integrators/path_tracing/path_estimator.h"

#include <chrono>

#include "integrators/eye_path/image_loop.h"
#include "integrators/path_tracing/guided_paths.h"
#include "integrators/path_tracing/wavefront.h"

namespace mote::integrators {

using namespace core;

namespace {

template <bool Media>
class PathEstimator final : public Estimator {
  public:
    PathEstimator(const Scene& scene, const RenderOptions& options, const PathSettings& settings)
        : scene_(scene), settings_(settings), loop_(scene, options) {
        settings_.limits.wanted = options.cells;
        if (settings_.guiding.mode != Guiding::off) train(options);
        if (!Media && WavefrontScene::suits(scene, settings_)) wavefront_.emplace(scene, settings_.limits);
    }

    bool pass(const PassContext& context, PassImage& image) override {
        const lights::ScatteringGuide& guide = guide_ ? *guide_ : lights::no_guide();
        const EyePacketSettings eye{.limits = settings_.limits, .guide = guide};
        return loop_.run(context, image, eye, [&](EyeTask<Media>& task) {
            if (wavefront_) {
                Wavefront paths(*wavefront_, task.walk(), guide);
                task.trace_all(paths);
                return;
            }
            task.walk().all_boundaries = settings_.equiangular != nullptr;
            task.for_each([&](const PacketPixels&) { trace_paths(scene_, settings_, task.packet()); });
        });
    }
    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        if (settings_.guiding.mode == Guiding::off) return;
        statistics.seconds["guiding"] += training_seconds_;
        statistics.values["guided"] = guide_ ? 1.0 : 0.0;
        if (!guide_) return;
        statistics.values["guiding_leaves"] +=
            double(guide_->surfaces().leaves().size() + guide_->media().leaves().size());
    }

  private:
    void train(const RenderOptions& options) {
        const auto start = std::chrono::steady_clock::now();
        guide_ = train_guide<Media>(scene_, options, settings_, guided_ray_work(), loop_.counters());
        training_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
    /// Processor time of a guided path's ray over that of an unguided one (docs/methods/guiding.md, "Cost").
    double guided_ray_work() const { return !Media && WavefrontScene::suits(scene_, settings_) ? 1.6 : 1.2; }

    const Scene& scene_;
    PathSettings settings_;
    std::optional<WavefrontScene> wavefront_;  ///< for scenes that it suits
    ImageLoop<Media> loop_;
    std::unique_ptr<const lights::LearnedGuide> guide_;  ///< of guided paths
    double training_seconds_ = 0.0;
};

}  // namespace

template <bool Media>
std::unique_ptr<Estimator> make_path_estimator(const Scene& scene, const RenderOptions& options,
                                               const PathSettings& settings) {
    return std::make_unique<PathEstimator<Media>>(scene, options, settings);
}
template std::unique_ptr<Estimator> make_path_estimator<true>(const Scene&, const RenderOptions&,
                                                              const PathSettings&);
template std::unique_ptr<Estimator> make_path_estimator<false>(const Scene&, const RenderOptions&,
                                                               const PathSettings&);

}  // namespace mote::integrators
