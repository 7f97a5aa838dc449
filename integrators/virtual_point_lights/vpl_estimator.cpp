#include "integrators/virtual_point_lights/vpl_estimator.h"

#include <tbb/parallel_for.h>

#include <chrono>
#include <mutex>

#include "integrators/eye_path/counters.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/screen_space_compensation/hidden_light.h"
#include "integrators/virtual_point_lights/path_receivers.h"
#include "integrators/virtual_point_lights/vpl_eye_tile.h"
#include "integrators/virtual_point_lights/vpl_shadow_maps.h"
#include "lights/reflective_shadow_maps/reflective_shadow_maps.h"

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
          bound_(settings.bound_for(scene.rays().bounds())),
          tile_size_(lane_tile(spacing())) {
        settings_.eye.wanted = options.cells;
        if (settings_.compensation.enabled && std::isfinite(bound_))
            transport_.emplace(scene, bound_, settings_.compensation);
        if (settings_.screen_space && settings_.screen_space->layers > 1 && std::isfinite(bound_))
            hidden_.emplace(scene, options, *settings.screen_space, settings.eye.max_depth, bound_);
        if (settings_.visibility.used_in(scene)) maps_.emplace(scene, settings_.visibility, options.memory);
        settings_.visibility.imperfect_map.memory = options.memory;
        if (settings_.visibility.imperfect)
            points_ = lights::sample_surfaces(
                scene, std::size_t(settings.visibility.imperfect_map.all_points), options.seed);
        if (settings_.reflective_maps > 0)
            reflective_.emplace(scene, settings.reflective_maps, settings.paths);
        if (settings_.filters) filter_.emplace(scene, options, settings_.filter);
    }

    /// Light that surfaces send to the eye is layers 1 and 2, direct and indirect (transport_layers.h).
    void finish(Film& film, CancelToken cancelled) override {
        if (filter_ && film.has_passes(2)) filter_->apply(film, filtered_layers(), cancelled);
        if (!settings_.screen_space || !std::isfinite(bound_)) return;
        constexpr std::size_t reflected[] = {std::size_t(Transport::direct),
                                             std::size_t(Transport::indirect)};
        ssbc_cost_ = add_screen_space_compensation(scene_, *settings_.screen_space, bound_,
                                                   {reflected, first_compensation_layer, first_hidden_layer},
                                                   cancelled, film);
    }

    bool pass(const PassContext& context, PassImage& image) override {
        if (context.cancelled) return false;
        lights::VplSet vpls = trace_lights(context);
        if (settings_.clamping.enabled)
            compensation::clamp_roughness(
                vpls, settings_.clamping,
                1.0f / float(settings_.interleaving * settings_.interleaving *
                             (settings_.vpls_shared_out() ? settings_.eye_paths() : 1)));
        counters_.add(vpls.rays, vpls.tracking);
        vpls_ += vpls.lights.size(), paths_ += vpls.paths;
        bytes_ = std::max(bytes_, vpls.memory_bytes());
        if (settings_.visibility.imperfect) make_imperfect_maps(vpls, context);
        prepare_selection(vpls, context);
        const int columns = (options_.width + tile_size_ - 1) / tile_size_;
        const int rows = (options_.height + tile_size_ - 1) / tile_size_;
        std::vector<lights::ReceiverStore> stores(maps_ ? std::size_t(columns) * std::size_t(rows) : 0);
        std::optional<SharedPixels> shared;
        if (settings_.upsampling > 1) shared.emplace(options_.width, options_.height, lattice(context));
        const auto tile = [&](int x0, int y0, int x1, int y1) {
            const std::size_t index = std::size_t(y0 / tile_size_ * columns + x0 / tile_size_);
            render_tile(context, image, vpls, maps_ ? &stores[index] : nullptr, shared ? &*shared : nullptr,
                        {x0, y0, x1, y1});
        };
        if (maps_ || hidden_ || shared) image.finish_late();
        if (!for_each_tile(options_.width, options_.height, tile_size_, context.cancelled, tile))
            return false;
        if (shared && !upsample(context, *shared, vpls, image)) return false;
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
        if (settings_.upsampling > 1) statistics.values["pixels_shaded_again"] += double(shaded_again_);
        if (settings_.visibility.imperfect) {
            statistics.seconds["imperfect_shadow_maps"] = imperfect_seconds_;
            statistics.values["imperfect_shadow_map_bytes"] = double(imperfect_.memory_bytes());
            statistics.lookups["imperfect_shadow_maps"] += imperfect_lookups_;
        }
        for (const auto& [name, value] : selection_statistics_.values) statistics.values[name] += value;
        for (const auto& [name, value] : selection_statistics_.seconds) statistics.seconds[name] += value;
        if (filter_) {
            statistics.seconds["filter_features"] = filter_->feature_seconds();
            statistics.seconds["filter"] = filter_->filter_seconds();
        }
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
    /// Pixels from lane to lane of a tile of receivers.
    int spacing() const { return std::max(settings_.interleaving, settings_.upsampling); }
    /// Pixels of a task: a multiple of such tiles.
    static constexpr int lane_tile(int n) { return EyeTile<Media>::side * n * std::max(1, 4 / n); }
    static constexpr std::size_t first_compensation_layer = transport_layer_count(Media);
    static constexpr std::size_t first_hidden_layer = first_compensation_layer + (Media ? 2 : 1);

    lights::VplSet trace_lights(const PassContext& context) const {
        lights::LightPathSettings paths = settings_.light_paths(options_.memory);
        if (reflective_) paths.paths = reflective_->paths();
        return lights::trace_light_paths(scene_, paths, options_.seed, context.index, options_.sampler,
                                         context.cancelled, reflective_ ? &*reflective_ : nullptr);
    }

    void make_imperfect_maps(const lights::VplSet& vpls, const PassContext& context) {
        const auto begin = std::chrono::steady_clock::now();
        imperfect_.build(points_, vpls, settings_.visibility.imperfect_map,
                         hash_keys(options_.seed, context.index), context.cancelled);
        imperfect_seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    void prepare_selection(const lights::VplSet& vpls, const PassContext& context) {
        RayCounters rays;
        TrackingCounters tracking;
        const std::uint64_t key = hash_keys(options_.seed, context.index, selection_stream);
        lights::SelectionPass pass{
            scene_, vpls, bound_, key, rays, tracking, selection_statistics_, context.cancelled, {}};
        pass.memory = options_.memory;
        selector_ = lights::all_vpls()->prepare(pass);  // while receivers are sampled
        pass.sample_receivers = [&](std::size_t paths) {
            const auto pixels = spread_pixels(options_.width, options_.height, paths, key);
            std::vector<lights::PathReceiver> receivers;
            with_tile(context, vpls, nullptr, [&](EyeTile<Media>& tile) {
                receivers = sample_path_receivers(scene_, options_, context, pixels, tile);
            });
            return receivers;
        };
        selector_ = settings_.selection->prepare(pass);
        counters_.add(rays, tracking);
    }

    struct Box {
        int x0, y0, x1, y1;
    };
    static constexpr std::size_t lane_count = lights::ReceiverTile::width;
    using Lanes = std::array<glm::ivec2, lane_count>;  ///< pixels; x < 0: none

    /// Calls render(tile) with a tile of receivers of one task.
    template <typename Render>
    void with_tile(const PassContext& context, const lights::VplSet& vpls, lights::ReceiverStore* store,
                   const Render& render) {
        WalkContext walk;
        walk.cancelled = context.cancelled;
        const auto scratch = std::make_unique<lights::GatherScratch>();
        const auto tile = std::make_unique<EyeTile<Media>>(
            scene_, settings_, vpls, *selector_, transport_ ? &*transport_ : nullptr, *scratch, walk,
            EyeShadowMaps{.lights = maps_ ? maps_->of_lights() : nullptr,
                          .receivers = store,
                          .imperfect = settings_.visibility.imperfect ? &imperfect_ : nullptr});
        render(*tile);
        counters_.add(walk.rays, walk.tracking);
        const std::lock_guard lock(cost_mutex_);
        imperfect_lookups_ += tile->imperfect_lookups();
        tile->selector().add_statistics(selection_statistics_);
        cost_.vertices += tile->compensation_cost().vertices;
        cost_.seconds += tile->compensation_cost().seconds;
    }

    void render_tile(const PassContext& context, PassImage& image, const lights::VplSet& vpls,
                     lights::ReceiverStore* store, SharedPixels* shared, const Box& box) {
        constexpr int side = EyeTile<Media>::side;
        const int n = spacing();
        with_tile(context, vpls, store, [&](EyeTile<Media>& tile) {
            for (int y = box.y0; y < box.y1; y += side * n)
                for (int x = box.x0; x < box.x1; x += side * n)
                    for (int i = 0; i < n * n; ++i) {
                        if (context.cancelled) return;  // a tile of many VPLs takes long
                        const int x0 = x + i % n, y0 = y + i / n;
                        Lanes lanes;
                        for (int lane = 0; lane < side * side; ++lane) {
                            const glm::ivec2 pixel(x0 + lane % side * n, y0 + lane / side * n);
                            lanes[std::size_t(lane)] =
                                pixel.x < box.x1 && pixel.y < box.y1 ? pixel : glm::ivec2(-1);
                        }
                        tile.gathers(!shared || shared->lattice().holds(x0, y0));
                        render_lanes(context, image, tile, lanes, shared);
                    }
        });
    }

    /// The lattice goes round from pass to pass.
    screenspace::ShadedLattice lattice(const PassContext& context) const {
        const auto n = std::uint32_t(settings_.upsampling);
        const std::uint32_t at = context.index % (n * n);
        return {int(n), int(at % n), int(at / n)};
    }

    /// Pixels between the lattice: those without similar neighbours once more, with their VPLs, the others by
    /// neighbours.
    bool upsample(const PassContext& context, const SharedPixels& shared, const lights::VplSet& vpls,
                  PassImage& image) {
        const std::vector<std::uint32_t> again = shared.again();
        constexpr std::size_t task = 256;
        tbb::parallel_for(std::size_t(0), (again.size() + task - 1) / task, [&](std::size_t t) {
            with_tile(context, vpls, nullptr, [&](EyeTile<Media>& tile) {
                const std::size_t end = std::min((t + 1) * task, again.size());
                for (std::size_t i = t * task; i < end && !context.cancelled; i += lane_count) {
                    Lanes lanes;
                    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
                        const auto pixel = i + lane < end ? int(again[i + lane]) : -1;
                        lanes[lane] = pixel < 0 ? glm::ivec2(-1)
                                                : glm::ivec2(pixel % options_.width, pixel / options_.width);
                    }
                    render_lanes(context, image, tile, lanes, nullptr);
                }
            });
        });
        shaded_again_ += again.size();
        if (context.cancelled) return false;
        using screenspace::LayerKind;
        const auto fill = [&](LayerKind kind, std::size_t layer) { shared.fill(kind, image.layer(layer)); };
        fill(LayerKind::surface, std::size_t(Transport::indirect));
        if (Media) fill(LayerKind::volume, std::size_t(Transport::multiple_scattering));
        if (settings_.compensation.enabled) fill(LayerKind::surface, first_compensation_layer);
        if (settings_.compensation.enabled && Media) fill(LayerKind::volume, first_compensation_layer + 1);
        return true;
    }

    /// Index of the one of n^2 shares of the VPLs that pixels of (column, row) gather. Every pixel comes by
    /// all of them, beginning anywhere: that makes its mean right, since the first VPLs of a set are not like
    /// the last.
    std::size_t share_of(const PassContext& context, int column, int row) const {
        const auto n = std::size_t(settings_.interleaving);
        const auto start = std::size_t(hash_keys(options_.seed, 0x696e7465726cull) % (n * n));
        if (!settings_.selection->takes_all()) return 0;
        return (std::size_t(column) % n + n * (std::size_t(row) % n) + start + context.index) % (n * n);
    }

    /// The pixels of the lanes, which have one share of the VPLs. `shared` receives what they see.
    void render_lanes(const PassContext& context, PassImage& image, EyeTile<Media>& tile, const Lanes& lanes,
                      SharedPixels* shared) const {
        const glm::ivec2 first = lanes[0];  // the others lie to the right and below
        const int n = settings_.interleaving;
        // Selected VPLs are not shared out: any of them may be selected, and neighbours select their own.
        const std::size_t shares = settings_.selection->takes_all() ? std::size_t(n) * std::size_t(n) : 1;
        const std::size_t share = first.x < 0 ? 0 : share_of(context, first.x, first.y);
        std::array<VplPixel, lane_count> sums;
        const auto samples = std::uint32_t(settings_.eye_paths());
        tile.place(first.x, first.y, n, 1.0f / float(samples));
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            const PassContext eye{context.index * samples + sample, context.filter, context.cancelled};
            for (std::size_t lane = 0; lane < lanes.size(); ++lane)
                if (lanes[lane].x >= 0)
                    tile.start(int(lane), make_eye_ray(scene_, options_, eye, lanes[lane].x, lanes[lane].y));
                else
                    tile.stop(int(lane));
            if (settings_.vpls_shared_out())
                tile.run({sample + samples * share, samples * shares}, float(samples * shares));
            else
                tile.run({share, shares}, float(shares));
            if (sample + 1 == samples) tile.gather_recorded();
            for (std::size_t lane = 0; lane < lanes.size(); ++lane)
                sums[lane].add(tile.sum(int(lane)), 1.0f / float(samples));
        }
        for (std::size_t lane = 0; lane < lanes.size(); ++lane)
            if (const glm::ivec2 p = lanes[lane]; p.x >= 0) {
                store_pixel(sums[lane], image, p.x, p.y);
                if (shared) shared->set(p.x, p.y, tile.seen(int(lane)));
            }
    }

    void store_pixel(const VplPixel& pixel, PassImage& image, int x, int y) const {
        store(pixel.transport, image, x, y, Media);
        if (!settings_.compensates()) return;
        for (std::size_t i = 0; i < (Media ? 2u : 1u); ++i)
            image.at(first_compensation_layer + i, x, y) = pixel.compensation[i];
    }

    /// Those of VPLs; what the screen-space compensation fills comes after the filter.
    std::vector<LayerFilter::Choice> filtered_layers() const {
        std::vector<LayerFilter::Choice> layers{
            {std::size_t(Transport::indirect), screenspace::LayerKind::surface}};
        if (Media)
            layers.push_back({std::size_t(Transport::multiple_scattering), screenspace::LayerKind::volume});
        if (!settings_.compensation.enabled) return layers;
        if (!settings_.screen_space)
            layers.push_back({first_compensation_layer, screenspace::LayerKind::surface});
        if (Media) layers.push_back({first_compensation_layer + 1, screenspace::LayerKind::volume});
        return layers;
    }

    const Scene& scene_;
    RenderOptions options_;
    VplSettings settings_;
    float bound_;
    int tile_size_;
    std::unique_ptr<lights::VplSelector> selector_;  ///< of this pass
    Statistics selection_statistics_;
    std::optional<lights::ReflectiveShadowMaps> reflective_;  ///< nothing: lights draw their paths
    lights::SurfaceSamples points_;
    lights::ImperfectShadowMaps imperfect_;  ///< of this pass, from these points
    double imperfect_seconds_ = 0.0;
    std::uint64_t imperfect_lookups_ = 0;
    std::optional<compensation::ResidualTransport> transport_;  ///< nothing: no compensation
    std::optional<HiddenLight> hidden_;                         ///< nothing: one layer
    std::optional<VplShadowMaps> maps_;                         ///< nothing: visibility is traced
    std::optional<LayerFilter> filter_;                         ///< nothing: pixels stay as they are
    SharedCounters counters_;
    std::mutex cost_mutex_;
    CompensationCost cost_;
    ScreenSpaceCost ssbc_cost_;
    std::uint64_t vpls_ = 0, paths_ = 0, shaded_again_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<Estimator> make_vpl_estimator(const Scene& scene, const RenderOptions& options,
                                              const VplSettings& settings) {
    if (scene.has_media()) return std::make_unique<VplEstimator<true>>(scene, options, settings);
    return std::make_unique<VplEstimator<false>>(scene, options, settings);
}

}  // namespace mote::integrators
