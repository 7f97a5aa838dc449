#include "integrators/single_scattering/single_scattering_estimator.h"

#include "integrators/single_scattering/interpolated_scattering.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;

namespace {

/// With more lights than this one of all is sampled: connecting to each would take longer than it saves.
constexpr std::size_t max_connected_lights = 16;

/// Along the ray from the eye x to the first surface at distance s, for the lights i with a position,
///   L = sum_i int_0^s T(x, t) sigma_s(t) f_p(t) T(t, x_i) V(t, x_i) I_i / |x(t) - x_i|^2 dt
/// (Engelhardt 2013, Ch. 9): by InScattering::march() for every pixel, or for some of them
/// (InterpolatedScattering). All other light is that of trace_eye().
template <bool Media>
class SingleScatteringEstimator final : public Estimator {
  public:
    SingleScatteringEstimator(const Scene& scene, const RenderOptions& options,
                              const ScatteringSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          positional_(positional_lights(scene)),
          loop_(scene, options, {.by_rows = true}) {
        settings_.eye.limits.max_depth = 1 + settings_.rays;
        settings_.eye.limits.wanted = options.cells;
        if (options.cells.contains(scattering_cell(settings_.lights)))
            settings_.eye.limits.wanted = options.cells | Transport::single_scattering;
        if (positional_.size() <= max_connected_lights) {
            others_.emplace(scene, positional_);
            settings_.eye.connected = positional_, settings_.eye.others = &*others_;
        }
        if constexpr (Media) prepare_media();
    }

    bool pass(const PassContext& context, PassImage& image) override {
        const PassNumbers numbers(options_, context.index);
        const std::vector<InScattering> lights = marched_lights(numbers);
        const bool interpolates = interpolated_ && !lights.empty();
        if (interpolates) interpolated_->make_room();
        const auto trace = [&](EyeTask<Media>& task) {
            MarchScratch scratch;
            scratch.walk.cancelled = context.cancelled;
            task.for_each_pixel([&](int x, int y) {
                const EyeRay eye = make_eye_ray(scene_, options_, context, x, y, &numbers.lens);
                scratch.walk.rng = eye.rng;
                EyeLight path = trace_eye<Media>(scene_, settings_.eye, lights, eye, scratch);
                if constexpr (Media) add_marched(path, eye, lights, image, x, y, scratch);
                if (!interpolates) image.finish(x, y);
                image.at(ScatteringLayer::emission, x, y) = path.sum[Transport::emission];
                image.at(ScatteringLayer::direct, x, y) = path.sum[Transport::direct];
            });
            loop_.counters().add(scratch.walk.rays, scratch.walk.tracking);
            const std::lock_guard lock(mutex_);
            counts_.rays += scratch.rays, counts_.steps += scratch.steps;
            counts_.unoccluded += scratch.unoccluded;
        };
        if (!loop_.run(context, image, {}, trace)) return false;
        return !interpolated_ || interpolated_->run(context, numbers, lights, image);
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        if (!Media) return;
        accelerations_->add_statistics(statistics);
        const ScatteringCounts more = interpolated_ ? interpolated_->counts() : ScatteringCounts{};
        statistics.values["marched_rays"] += double(counts_.rays + more.rays);
        statistics.values["march_steps"] += double(counts_.steps + more.steps);
        statistics.values["unoccluded_rays"] += double(counts_.unoccluded + more.unoccluded);
        if (interpolated_)
            interpolated_->add_statistics(statistics);
        else
            statistics.values["lit_pixels"] += double(counts_.rays);
    }

  private:
    void prepare_media() {
        if (settings_.lights != ScatteringLights::other)
            require_few_lights(scene_, settings_, positional_.size());
        accelerations_.emplace(scene_, settings_.accelerations(), options_.memory);
        settings_.eye.maps = accelerations_->maps();
        settings_.eye.voxels = settings_.march.voxels;
        settings_.eye.other_lights =
            settings_.lights != ScatteringLights::positional && has_other_lights(scene_);
        if (settings_.sampling != ScatteringSampling::full)
            interpolated_.emplace(scene_, options_, settings_, loop_.counters());
    }

    std::vector<InScattering> marched_lights(const PassNumbers& numbers) const {
        std::vector<InScattering> lights;
        if (!Media || !settings_.eye.limits.wanted[Transport::single_scattering] ||
            settings_.lights == ScatteringLights::other)
            return lights;
        const MarchSettings march = settings_.march_from(numbers.march.x);
        for (const Emitter* light : positional_)
            lights.emplace_back(scene_, *light, march, accelerations_->of(*light));
        return lights;
    }

    /// The light of `lights` along the first ray: marched, or the point from which it is interpolated.
    void add_marched(EyeLight& path, const EyeRay& eye, std::span<const InScattering> lights,
                     PassImage& image, int x, int y, MarchScratch& scratch) {
        FirstSurface first;
        if (path.first) first = {path.first->t, path.first->geometric_normal};
        if (interpolated_) {
            if (!lights.empty())
                interpolated_->set_point(std::size_t(pixel_key(options_, x, y)), {eye.film, first});
        } else {
            const MediumState state = scene_.eye_medium_state(eye.ray);
            for (const InScattering& light : lights) {
                Ray lit = eye.ray;
                const RayEnd end = lit_end(light, eye.ray, first);
                if (end.dark()) continue;
                scratch.walk.cancelled.check();
                lit.t_max = end.distance;
                path.sum[Transport::single_scattering] += light.march(lit, state, scratch).radiance;
                if (settings_.show_samples) image.at(ScatteringLayer::marched_rays, x, y) += Rgb(1.0f);
            }
        }
        image.at(ScatteringLayer::single_scattering, x, y) = path.sum[Transport::single_scattering];
    }

    const Scene& scene_;
    RenderOptions options_;
    ScatteringSettings settings_;
    std::vector<const Emitter*> positional_;
    std::optional<lights::OtherLights> others_;  ///< where every vertex is connected to the positional ones
    std::optional<ScatteringAccelerations> accelerations_;  ///< nothing without media
    ImageLoop<Media> loop_;
    std::optional<InterpolatedScattering> interpolated_;  ///< nothing where every pixel is marched
    std::mutex mutex_;
    ScatteringCounts counts_;  ///< of eye paths
};

}  // namespace

std::unique_ptr<Estimator> make_single_scattering_estimator(const Scene& scene, const RenderOptions& options,
                                                            const ScatteringSettings& settings) {
    if (scene.has_media()) return std::make_unique<SingleScatteringEstimator<true>>(scene, options, settings);
    return std::make_unique<SingleScatteringEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
