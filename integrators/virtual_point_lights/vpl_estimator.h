// The passes of `mote_vpl`.
#pragma once

#include <mutex>

#include "integrators/virtual_point_lights/missing_light.h"
#include "integrators/virtual_point_lights/path_receivers.h"
#include "integrators/virtual_point_lights/vpl_gatherer.h"

namespace mote::integrators {

/// The passes of `mote_vpl`. With the VPLs y_j of a pass, of light L_j, a receiver x gets
///   L(x) = sum_j w_j f*(x) min(G*(x, y_j), b) V*(x, y_j) L_j  +  what the bound b took
/// (Engelhardt 2013, Eqs. 10.4 and 10.5). The selection determines j and w_j, the visibility V*, the residual
/// the last term.
template <bool Media>
class VplEstimator : public core::Estimator {
  public:
    VplEstimator(const core::Scene& scene, const core::RenderOptions& options, const VplSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          bound_(settings.bound_for(scene.rays().bounds())),
          source_(settings.light_source(scene, options.memory)),
          visibility_(settings.visibility->prepare(scene, options.seed, options.memory)),
          residual_(settings.residual->prepare(
              {scene, options_, bound_, settings.eye.max_depth, transport_layer_count(Media)})),
          loop_(scene, options,
                {.interleaving = settings.interleaving,
                 .upsampling = settings.upsampling,
                 .eye_samples = settings.eye_paths(),
                 .upsampled = vpl_layers()}),
          filter_(scene, options, settings.filter,
                  settings.filters ? vpl_layers() : std::vector<LayerFilter::Choice>{}) {
        settings_.eye.wanted = options.cells;
        if (options.estimates_missing) missing_.emplace(scene, options, settings.eye, bound_);
    }

    bool pass(const core::PassContext& context, core::PassImage& image) override {
        if (context.cancelled) return false;
        const lights::VplSet vpls = trace(context);
        const lights::VplSelector selector = select(vpls, context);
        const lights::VisibilityPass visible{
            vpls, bound_, core::hash_keys(options_.seed, context.index), loop_.tasks(), context.cancelled,
            image};
        visibility_->begin(visible), residual_->begin(image);
        const VplPass shared{vpls, selector, *visibility_, *residual_};
        const auto gather = [&](EyeTask<Media>& task) {
            VplGatherer<Media> gatherer(scene_, settings_, shared, task.packet(), task.index());
            task.for_each([&](const PacketPixels& pixels) { gatherer.run(pixels); },
                          [&](const PacketPixels& pixels) { gatherer.store_restored(pixels, image); });
            const std::lock_guard lock(mutex_);
            gatherer.add_statistics(selection_statistics_);
        };
        return loop_.run(context, image, EyeReceivers<Media>::packet_settings(settings_), gather) &&
               residual_->pass(context, vpls, image) && visibility_->finish(visible) &&
               (!missing_ || missing_->pass(context, image, transport_layer_count(Media)));
    }

    void finish(core::Film& film, core::CancelToken cancelled) override {
        filter_.apply(film, cancelled);
        residual_->finish(film, cancelled);
    }
    double seconds_once() const override { return filter_.feature_seconds(); }

    void add_statistics(core::Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        if (std::isfinite(bound_)) statistics.values["bound"] = bound_;
        for (const auto& [name, value] : selection_statistics_.values) statistics.values[name] += value;
        for (const auto& [name, value] : selection_statistics_.seconds) statistics.seconds[name] += value;
        visibility_->add_statistics(statistics);
        residual_->add_statistics(statistics);
        filter_.add_statistics(statistics);
        if (missing_) missing_->add_statistics(statistics);
    }

  protected:
    lights::VplSet trace(const core::PassContext& context) {
        lights::VplSet vpls =
            source_->trace(options_.seed, context.index, options_.sampler, context.cancelled);
        const int shares = settings_.interleaving * settings_.interleaving *
                           (settings_.vpls_shared_out() ? settings_.eye_paths() : 1);
        if (settings_.clamping.enabled)
            compensation::clamp_roughness(vpls, settings_.clamping, 1.0f / float(shares));
        loop_.counters().add(vpls.rays, vpls.tracking);
        vpls_ += vpls.lights.size(), paths_ += vpls.paths;
        bytes_ = std::max(bytes_, vpls.memory_bytes());
        return vpls;
    }

    lights::VplSelector select(const lights::VplSet& vpls, const core::PassContext& context) {
        const std::uint64_t key = core::hash_keys(options_.seed, context.index, selection_stream);
        core::WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto receivers = sample_path_receivers<Media>(scene_, settings_, options_, context,
                                                            settings_.selection->receiver_paths(), key, walk);
        auto selector = settings_.selection->prepare({scene_, vpls, bound_, key, walk.rays, walk.tracking,
                                                      selection_statistics_, context.cancelled, receivers,
                                                      options_.memory});
        loop_.counters().add(walk.rays, walk.tracking);
        return selector;
    }

    /// Layers of VPLs, which are filtered and interpolated; what the residual finds in image space comes
    /// after that.
    std::vector<LayerFilter::Choice> vpl_layers() const {
        using screenspace::LayerKind;
        std::vector<LayerFilter::Choice> layers{{std::size_t(Transport::indirect), LayerKind::surface}};
        if (Media) layers.push_back({std::size_t(Transport::multiple_scattering), LayerKind::volume});
        const std::size_t restored = transport_layer_count(Media);
        if (settings_.residual->in_passes(true)) layers.push_back({restored, LayerKind::surface});
        if (Media && settings_.residual->in_passes(false))
            layers.push_back({restored + 1, LayerKind::volume});
        return layers;
    }

    const core::Scene& scene_;
    core::RenderOptions options_;
    VplSettings settings_;
    float bound_;  ///< b [1/m^2]
    std::unique_ptr<lights::LightSource> source_;
    std::unique_ptr<lights::PreparedVisibility> visibility_;
    std::unique_ptr<compensation::PreparedResidual> residual_;
    ImageLoop<Media> loop_;
    LayerFilter filter_;
    std::optional<MissingLight<Media>> missing_;
    std::mutex mutex_;
    core::Statistics selection_statistics_;
    std::uint64_t vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace mote::integrators
