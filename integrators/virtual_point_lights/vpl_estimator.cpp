#include "integrators/virtual_point_lights/vpl_estimator.h"

#include <mutex>

#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/screen_space_compensation/hidden_light.h"
#include "integrators/virtual_point_lights/vpl_eye_tile.h"
#include "integrators/virtual_point_lights/vpl_shadow_maps.h"

namespace mote::integrators {

using namespace core;
namespace {

template <bool Media>
class VplEstimator final : public Estimator {
  public:
    VplEstimator(const Scene& scene, const RenderOptions& options, const VplSettings& settings)
        : scene_(scene),
          options_(options),
          settings_(settings),
          bound_(settings.bound_for(scene.rays().bounds())) {
        settings_.eye.wanted = wanted_transport(options);
        if (settings_.compensation.enabled && std::isfinite(bound_))
            transport_.emplace(scene, bound_, settings_.compensation);
        if (settings_.screen_space && settings_.screen_space->layers > 1 && std::isfinite(bound_))
            hidden_.emplace(scene, options, settings, bound_);
        if (settings_.visibility.used_in(scene)) maps_.emplace(scene, settings_.visibility);
    }

    /// Light that surfaces send to the eye is layers 1 and 2, direct and indirect (transport_layers.h).
    void finish(Film& film, CancelToken cancelled) override {
        if (!settings_.screen_space || !std::isfinite(bound_)) return;
        constexpr std::size_t reflected[] = {std::size_t(Transport::direct),
                                             std::size_t(Transport::indirect)};
        ssbc_cost_ = add_screen_space_compensation(scene_, *settings_.screen_space, bound_,
                                                   {reflected, first_compensation_layer, first_hidden_layer},
                                                   cancelled, film);
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        const lights::VplSet vpls =
            lights::trace_light_paths(scene_, settings_.light_paths(), options_.seed, context.index,
                                      options_.sampler, context.cancelled);
        counters_.add(vpls.rays, vpls.tracking);
        vpls_ += vpls.lights.size(), paths_ += vpls.paths;
        bytes_ = std::max(bytes_, vpls.memory_bytes());
        const int columns = (options_.width + tile_size - 1) / tile_size;
        const int rows = (options_.height + tile_size - 1) / tile_size;
        std::vector<lights::ReceiverStore> stores(maps_ ? std::size_t(columns) * std::size_t(rows) : 0);
        const auto tile = [&](int x0, int y0, int x1, int y1) {
            const std::size_t index = std::size_t(y0 / tile_size * columns + x0 / tile_size);
            render_tile(context, image, vpls, maps_ ? &stores[index] : nullptr, x0, y0, x1, y1);
        };
        if (maps_ || hidden_) image.finish_late();
        if (!for_each_tile(options_.width, options_.height, tile_size, context.cancelled, tile)) return false;
        if (hidden_ && !hidden_->template pass<Media>(context, vpls, first_hidden_layer, image)) return false;
        return !maps_ || maps_->add_light(vpls, bound_, stores, context.cancelled, image);
    }

    void add_statistics(Statistics& statistics) const override {
        counters_.report(statistics, Media);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        if (std::isfinite(bound_)) statistics.values["bound"] = bound_;
        if (maps_)
            maps_->add_statistics(statistics);
        else if (settings_.visibility.shadow_maps)
            statistics.warnings.push_back("visibility 'shadow_map' has no effect: there are no media");
        if (settings_.screen_space) {
            statistics.values["ssbc_samples"] = double(ssbc_cost_.samples);
            statistics.seconds["ssbc"] = ssbc_cost_.seconds;
            statistics.values["ssbc_cpu_seconds"] = ssbc_cost_.cpu_seconds;
            if (hidden_) hidden_->add_statistics(statistics);
        }
        if (!transport_) return;
        statistics.values["compensation_vertices"] += double(cost_.vertices);
        statistics.values["compensation_thread_seconds"] += cost_.seconds;
        statistics.values["compensation_bytes"] = double(transport_->memory_bytes());
    }

  private:
    static constexpr int tile_size = 16;
    static constexpr std::size_t first_compensation_layer = transport_layer_count(Media);
    static constexpr std::size_t first_hidden_layer = first_compensation_layer + (Media ? 2 : 1);

    void render_tile(const PassContext& context, PassImage& image, const lights::VplSet& vpls,
                     lights::ReceiverStore* store, int x0, int y0, int x1, int y1) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto scratch = std::make_unique<lights::GatherScratch>();
        const auto tile = std::make_unique<EyeTile<Media>>(
            scene_, settings_, bound_, vpls, transport_ ? &*transport_ : nullptr, *scratch, walk,
            EyeShadowMaps{maps_ ? maps_->of_lights() : nullptr, store});
        constexpr int side = EyeTile<Media>::side;
        for (int y = y0; y < y1; y += side)
            for (int x = x0; x < x1; x += side) {
                if (context.cancelled) return;  // a tile of many VPLs takes long
                render_lanes(context, image, *tile, x, y, x1, y1);
            }
        counters_.add(walk.rays, walk.tracking);
        const std::lock_guard lock(cost_mutex_);
        cost_.vertices += tile->compensation_cost().vertices;
        cost_.seconds += tile->compensation_cost().seconds;
    }

    void render_lanes(const PassContext& context, PassImage& image, EyeTile<Media>& tile, int x0, int y0,
                      int x1, int y1) const {
        constexpr int side = EyeTile<Media>::side;
        std::array<VplPixel, side * side> sums;
        const auto samples = std::uint32_t(settings_.eye_samples);
        tile.place(x0, y0, 1.0f / float(samples));
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            const PassContext eye{context.index * samples + sample, context.filter, context.cancelled};
            for (int lane = 0; lane < side * side; ++lane) {
                const int x = x0 + lane % side, y = y0 + lane / side;
                if (x < x1 && y < y1)
                    tile.start(lane, make_eye_ray(scene_, options_, eye, x, y));
                else
                    tile.stop(lane);
            }
            if (settings_.vpls_shared_out())
                tile.run({sample, samples}, float(samples));
            else
                tile.run({}, 1.0f);
            for (int lane = 0; lane < side * side; ++lane)
                sums[std::size_t(lane)].add(tile.sum(lane), 1.0f / float(samples));
        }
        for (int lane = 0; lane < side * side; ++lane) {
            const int x = x0 + lane % side, y = y0 + lane / side;
            if (x < x1 && y < y1) store_pixel(sums[std::size_t(lane)], image, x, y);
        }
    }

    void store_pixel(const VplPixel& pixel, PassImage& image, int x, int y) const {
        store(pixel.transport, image, x, y, Media);
        if (!settings_.compensates()) return;
        for (std::size_t i = 0; i < (Media ? 2u : 1u); ++i)
            image.at(first_compensation_layer + i, x, y) = pixel.compensation[i];
    }

    const Scene& scene_;
    RenderOptions options_;
    VplSettings settings_;
    float bound_;
    std::optional<compensation::ResidualTransport> transport_;  ///< nothing: no compensation
    std::optional<HiddenLight> hidden_;                         ///< nothing: one layer
    std::optional<VplShadowMaps> maps_;                         ///< nothing: visibility is traced
    SharedCounters counters_;
    std::mutex cost_mutex_;
    CompensationCost cost_;
    ScreenSpaceCost ssbc_cost_;
    std::uint64_t vpls_ = 0, paths_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<Estimator> make_vpl_estimator(const Scene& scene, const RenderOptions& options,
                                              const VplSettings& settings) {
    if (scene.has_media()) return std::make_unique<VplEstimator<true>>(scene, options, settings);
    return std::make_unique<VplEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
