#include "integrators/single_scattering/single_scattering_estimator.h"

#include "integrators/single_scattering/interpolated_scattering.h"

namespace mote::integrators {

using namespace core;
using namespace screenspace;

namespace {

constexpr int tile_size = 16;
/// With more lights than this one of all is sampled: connecting to each would take longer than it saves.
constexpr std::size_t max_connected_lights = 16;

template <bool Media>
class SingleScatteringEstimator final : public Estimator {
  public:
    SingleScatteringEstimator(const Scene& scene, const RenderOptions& options,
                              const ScatteringSettings& settings)
        : scene_(scene), options_(options), settings_(settings), positional_(positional_lights(scene)) {
        settings_.eye.limits.max_depth = 1 + settings_.rays;
        settings_.eye.limits.wanted = options.cells;
        if (options.cells.contains(scattering_cell(settings_.lights)))
            settings_.eye.limits.wanted = options.cells | Transport::single_scattering;
        if (positional_.size() <= max_connected_lights) {
            others_.emplace(scene, positional_);
            settings_.eye.connected = positional_, settings_.eye.others = &*others_;
        }
        if (!Media) return;
        if (settings_.lights != ScatteringLights::other)
            require_few_lights(scene, settings_, positional_.size());
        accelerations_.emplace(scene, settings.accelerations(), options.memory);
        settings_.eye.maps = accelerations_->maps();
        settings_.eye.voxels = settings.march.voxels;
        settings_.eye.other_lights =
            settings_.lights != ScatteringLights::positional && has_other_lights(scene);
    }

    bool pass(const PassContext& context, PassImage& image) override;
    void add_statistics(Statistics& statistics) const override;

  private:
    Ray eye_ray(const Vec2& film, const PassNumbers& numbers) const {
        return scene_.camera().sample_ray(film, numbers.lens);
    }
    void render_eye(const PassContext& context, const PassNumbers& numbers,
                    std::span<const InScattering> lights, PassImage& image, int x, int y,
                    MarchScratch& scratch);

    const Scene& scene_;
    RenderOptions options_;
    ScatteringSettings settings_;
    std::vector<const Emitter*> positional_;
    std::optional<lights::OtherLights> others_;  ///< where every vertex is connected to the positional ones
    std::optional<ScatteringAccelerations> accelerations_;  ///< nothing without media
    SharedCounters counters_;
    InterpolatedScattering interpolated_{scene_, options_, settings_, counters_};
    std::mutex mutex_;
    ScatteringCounts counts_;  ///< of eye paths
};

template <bool Media>
void SingleScatteringEstimator<Media>::render_eye(const PassContext& context, const PassNumbers& numbers,
                                                  std::span<const InScattering> lights, PassImage& image,
                                                  int x, int y, MarchScratch& scratch) {
    const std::uint64_t pixel = core::pixel_key(options_, x, y);
    const EyeRay eye = make_eye_ray(scene_, options_, context, x, y, &numbers.lens);
    scratch.walk.rng = eye.rng;
    EyeLight path = trace_eye<Media>(scene_, settings_.eye, lights, eye, scratch);
    if constexpr (Media) {
        const FirstSurface first =
            path.first ? FirstSurface{path.first->t, path.first->geometric_normal} : FirstSurface{};
        if (settings_.sampling != ScatteringSampling::full && !lights.empty())
            interpolated_.set_point(std::size_t(pixel), {eye.film, first});
        const MediumState state = scene_.eye_medium_state(eye.ray);
        for (const InScattering& light : lights) {
            if (settings_.sampling != ScatteringSampling::full) break;
            Ray lit = eye.ray;
            const RayEnd end = lit_end(light, eye.ray, first);
            if (end.dark()) continue;
            scratch.walk.cancelled.check();
            lit.t_max = end.distance;
            path.sum[Transport::single_scattering] += light.march(lit, state, scratch).radiance;
            if (settings_.show_samples) image.at(ScatteringLayer::marched_rays, x, y) += Rgb(1.0f);
        }
        image.at(ScatteringLayer::single_scattering, x, y) = path.sum[Transport::single_scattering];
    }
    if (!Media || settings_.sampling == ScatteringSampling::full || lights.empty()) image.finish(x, y);
    image.at(ScatteringLayer::emission, x, y) = path.sum[Transport::emission],
                                           image.at(ScatteringLayer::direct, x, y) =
                                               path.sum[Transport::direct];
}

template <bool Media>
bool SingleScatteringEstimator<Media>::pass(const PassContext& context, PassImage& image) {
    const PassNumbers numbers(options_, context.index);
    MarchSettings march = settings_.march;
    march.offset = numbers.march.x;
    march.rule =
        settings_.in_scattering == AlongRay::uniform_steps ? MarchRule::uniform : MarchRule::equiangular;
    std::vector<InScattering> lights;
    if (Media && settings_.eye.limits.wanted[Transport::single_scattering] &&
        settings_.lights != ScatteringLights::other)
        for (const Emitter* light : positional_)
            lights.emplace_back(scene_, *light, march, accelerations_->of(*light));
    const bool full = settings_.sampling == ScatteringSampling::full;
    if (!full && !lights.empty()) interpolated_.make_room();

    const bool eyes = for_each_tile(options_.width, options_.height, tile_size, context.cancelled,
                                    [&](int x0, int y0, int x1, int y1) {
                                        MarchScratch scratch;
                                        scratch.walk.cancelled = context.cancelled;
                                        for (int y = y0; y < y1; ++y)
                                            for (int x = x0; x < x1; ++x)
                                                render_eye(context, numbers, lights, image, x, y, scratch);
                                        counters_.add(scratch.walk.rays, scratch.walk.tracking);
                                        const std::lock_guard lock(mutex_);
                                        counts_.rays += scratch.rays, counts_.steps += scratch.steps;
                                        counts_.unoccluded += scratch.unoccluded;
                                        if (full) counts_.candidates += scratch.rays;
                                    });
    if (!eyes) return false;
    return full || interpolated_.run(context, numbers, lights, image);
}

template <bool Media>
void SingleScatteringEstimator<Media>::add_statistics(Statistics& statistics) const {
    counters_.report(statistics, Media);
    if (!Media) return;
    const ScatteringCounts& more = interpolated_.counts();
    statistics.values["marched_rays"] += double(counts_.rays + more.rays);
    statistics.values["march_steps"] += double(counts_.steps + more.steps);
    statistics.values["unoccluded_rays"] += double(counts_.unoccluded + more.unoccluded);
    accelerations_->add_statistics(statistics);
    statistics.values["lit_pixels"] += double(counts_.candidates + more.candidates);
    if (settings_.sampling == ScatteringSampling::full) return;
    statistics.values["filled_pixels"] += double(more.filled);
    statistics.values["screen_space_bytes_peak"] = double(more.bytes);
    if (settings_.sampling != ScatteringSampling::epipolar) return;
    statistics.values["epipolar_lines"] += double(more.lines);
    statistics.values["epipolar_texels"] += double(more.texels);
}

}  // namespace

std::unique_ptr<Estimator> make_single_scattering_estimator(const Scene& scene, const RenderOptions& options,
                                                            const ScatteringSettings& settings) {
    if (scene.has_media()) return std::make_unique<SingleScatteringEstimator<true>>(scene, options, settings);
    return std::make_unique<SingleScatteringEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
