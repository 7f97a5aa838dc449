#include "core/render/cpu_clock.h"
#include "integrators/eye_path/image_loop.h"
#include "integrators/upbp/effort_trials.h"

namespace mote::integrators {

using namespace core;

namespace {

template <bool Media>
class UpbpEstimator final : public Estimator {
  public:
    UpbpEstimator(const Scene& scene, const RenderOptions& options, const UpbpSettings& settings)
        : passes_(scene, options, settings, {options.width, options.height}),
          loop_(scene, options, {.by_rows = true}) {
        if (!settings.efforts_by_trial()) return;
        const Stopwatch stopwatch(trial_seconds_);
        efforts_ = efficient_efforts(trial_of_efforts<Media>(scene, options, settings));
    }

    bool pass(const PassContext& context, PassImage& image) override {
        image.finish_late();  // any light path may reach any pixel
        const BidirectionalSettings settings = passes_.settings_of(context.index, efforts_);
        UpbpLights lights;
        if (!passes_.trace_light_paths(context, settings, lights)) return false;
        add_splats(lights.splats, context.filter, image);
        on_surfaces_ += lights.vertices.on_surfaces(), in_media_ += lights.vertices.in_media();
        beams_ += lights.beams.size();
        radius_ = settings.merging.radius[std::size_t(Merge::surface)];
        return loop_.run(context, image, {}, [&](EyeTask<Media>& task) {
            passes_.trace_eye_paths(
                context, settings, lights, task.walk(),
                [&](const auto& visit) { task.for_each_pixel(visit); },
                [&](int x, int y, const Contribution& c) { image.at(c.layer, x, y) += c.light; });
        });
    }
    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        passes_.counters().report(statistics, Media);
        statistics.values["light_vertices_on_surfaces"] += double(on_surfaces_);
        statistics.values["light_vertices_in_media"] += double(in_media_);
        statistics.values["light_beams"] += double(beams_);
        statistics.values["kernel_radius_surface"] = radius_;
        constexpr std::array<const char*, technique_count> names{"surf", "pp3d", "pb2d", "bb1d", "bpt"};
        for (std::size_t t = 0; t < technique_count; ++t)
            statistics.values[std::string("effort_") + names[t]] = efforts_[t];
        if (trial_seconds_ > 0.0) statistics.seconds["effort_trial"] += trial_seconds_;
    }

  private:
    UpbpPasses<Media> passes_;
    ImageLoop<Media> loop_;
    PerTechnique efforts_ = full_efforts;
    std::uint64_t on_surfaces_ = 0, in_media_ = 0, beams_ = 0;
    double radius_ = 0.0, trial_seconds_ = 0.0;
};

}  // namespace

BeamLength possible_length(const Scene& scene, BeamLength wanted) {
    return short_beams_possible(scene) ? wanted : BeamLength::long_beam;
}

std::unique_ptr<Estimator> make_upbp_estimator(const Scene& scene, const RenderOptions& options,
                                               const UpbpSettings& settings) {
    if (scene.has_media()) return std::make_unique<UpbpEstimator<true>>(scene, options, settings);
    return std::make_unique<UpbpEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
