#include "integrators/path_tracing/path_estimator.h"

#include "core/render/cpu_clock.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/path_tracing/guided_paths.h"
#include "integrators/path_tracing/path_recorder.h"
#include "integrators/path_tracing/wavefront.h"

namespace mote::integrators {

using namespace core;

namespace {

template <bool Media>
class PathEstimator final : public Estimator {
  public:
    PathEstimator(const Scene& scene, const RenderOptions& options, const PathSettings& settings)
        : scene_(scene), settings_(settings), loop_(scene, options), again_(scene, options) {
        settings_.limits.wanted = options.cells;
        settings_.limits.light_samples = light_samples_for(scene);
        if (!Media && WavefrontScene::suits(scene, settings_)) wavefront_.emplace(scene, settings_.limits);
        if (settings_.guiding.mode == Guiding::off) return;
        const Stopwatch stopwatch(training_seconds_);
        training_.emplace(scene, options, settings_, guided_ray_work(), again_.counters());
    }

    bool pass(const PassContext& context, PassImage& image) override {
        const std::uint32_t learns = training_ ? training_->picture_passes() : 0;
        if (learns == 0) return trace(context, image);
        return catch_up(context, image, learns) &&
               (context.index < learns ? trace_and_learn(loop_, context, image) : trace(context, image));
    }
    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        if (settings_.guiding.mode == Guiding::off) return;
        statistics.seconds["guiding"] += training_seconds_;
        statistics.values["guided"] = guide() ? 1.0 : 0.0;
        Statistics guiding;
        again_.add_statistics(guiding);
        statistics.values["guiding_rays"] += double(guiding.rays["closest"] + guiding.rays["occlusion"]);
        if (!guide()) return;
        statistics.values["guiding_leaves"] += double(guide()->leaves());
        statistics.values["guided_vertices"] = guide()->candidates() > 0 ? 1.0 : 0.0;
    }

  private:
    const lights::LearnedGuide* guide() const { return training_ ? training_->guide() : nullptr; }
    EyePacketSettings eye() const {
        if (guide()) return {.limits = settings_.limits, .guide = *guide()};
        return {.limits = settings_.limits};
    }
    bool trace(const PassContext& context, PassImage& image) {
        return loop_.run(context, image, eye(), [&](EyeTask<Media>& task) {
            if (wavefront_) {
                Wavefront paths(*wavefront_, task.walk(), eye().guide);
                task.trace_all(paths);
            } else {
                trace_packets(task, nullptr, nullptr);
            }
        });
    }
    void trace_packets(EyeTask<Media>& task, PathRecorder<Media>* recorder, lights::GuidingSamples* samples) {
        task.walk().all_boundaries = settings_.equiangular != nullptr;
        task.for_each([&](const PacketPixels&) {
            trace_paths(scene_, settings_, task.packet(), recorder);
            if (recorder) recorder->finish(task.packet(), *samples);
        });
    }
    bool trace_and_learn(ImageLoop<Media>& loop, const PassContext& context, PassImage& image) {
        std::vector<lights::GuidingSamples> samples(loop.tasks());
        const bool done = loop.run(context, image, eye(), [&](EyeTask<Media>& task) {
            PathRecorder<Media> recorder(training_->largest_parts());
            const bool records = training_->records(context.index, task.index());
            trace_packets(task, records ? &recorder : nullptr, &samples[task.index()]);
        });
        if (!done) return false;
        const Stopwatch stopwatch(training_seconds_);
        training_->learn(samples);
        return true;
    }
    /// Learns from the picture's passes before this one that another run has traced.
    bool catch_up(const PassContext& context, const PassImage& image, std::uint32_t learns) {
        if (training_->learned() > std::min(context.index, learns)) training_->restart();
        if (training_->learned() == std::min(context.index, learns)) return true;
        PassImage none(image.width(), image.height(), image.layers());
        for (; training_->learned() < std::min(context.index, learns); none.clear())
            if (!trace_and_learn(
                    again_, {training_->learned(), context.filter, context.cancelled, context.part}, none))
                return false;
        return true;
    }
    /// Processor time of a guided path's ray over that of an unguided one (docs/methods/guiding.md, "Cost").
    double guided_ray_work() const { return wavefront_ ? 1.6 : 1.2; }

    const Scene& scene_;
    PathSettings settings_;
    std::optional<WavefrontScene> wavefront_;  ///< for scenes that it suits
    ImageLoop<Media> loop_;
    ImageLoop<Media> again_;  ///< counts what is no work of the pass: training, and passes of another run
    std::optional<GuideTraining<Media>> training_;  ///< of guided paths
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
