#include "integrators/virtual_point_lights/vpl_estimator.h"

#include <chrono>
#include <mutex>

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
          loop_(scene, options,
                {.interleaving = settings.interleaving,
                 .upsampling = settings.upsampling,
                 .eye_samples = settings.eye_paths(),
                 .upsampled = vpl_layers()}) {
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
        if (filter_ && film.has_passes(2)) filter_->apply(film, vpl_layers(), cancelled);
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
        loop_.counters().add(vpls.rays, vpls.tracking);
        vpls_ += vpls.lights.size(), paths_ += vpls.paths;
        bytes_ = std::max(bytes_, vpls.memory_bytes());
        if (settings_.visibility.imperfect) make_imperfect_maps(vpls, context);
        prepare_selection(vpls, context);
        std::vector<lights::ReceiverStore> stores(maps_ ? loop_.tasks() : 0);
        if (maps_ || hidden_) image.finish_late();
        const auto task = [&](EyeTask<Media>& t) {
            with_tile(t.packet(), vpls, maps_ ? &stores[t.index()] : nullptr, [&](EyeTile<Media>& tile) {
                t.for_each([&](const PacketPixels& pixels) { tile.run(pixels); },
                           [&](const PacketPixels& pixels) { store_compensation(tile, pixels, image); });
            });
        };
        if (!loop_.run(context, image, EyeTile<Media>::packet_settings(settings_), task)) return false;
        if (hidden_ && !hidden_->template pass<Media>(context, vpls, first_hidden_layer, image)) return false;
        return !maps_ || maps_->add_light(vpls, bound_, stores, context.cancelled, image);
    }

    void add_statistics(Statistics& statistics) const override {
        loop_.add_statistics(statistics);
        statistics.values["vpls"] += double(vpls_);
        statistics.values["light_paths"] += double(paths_);
        statistics.values["vpl_bytes_peak"] = double(bytes_);
        if (std::isfinite(bound_)) statistics.values["bound"] = bound_;
        if (maps_)
            maps_->add_statistics(statistics);
        else if (settings_.visibility.shadow_maps)
            statistics.warnings.push_back("visibility 'shadow_map' has no effect: there are no media");
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
            WalkContext walk;
            walk.cancelled = context.cancelled;
            EyePacket<Media> packet(scene_, EyeTile<Media>::packet_settings(settings_), walk);
            with_tile(packet, vpls, nullptr, [&](EyeTile<Media>& tile) {
                receivers = sample_path_receivers(scene_, options_, context, pixels, packet, tile);
            });
            loop_.counters().add(walk.rays, walk.tracking);
            return receivers;
        };
        selector_ = settings_.selection->prepare(pass);
        loop_.counters().add(rays, tracking);
    }

    /// Calls render(tile) with what a task does at the vertices of a packet.
    template <typename Render>
    void with_tile(EyePacket<Media>& packet, const lights::VplSet& vpls, lights::ReceiverStore* store,
                   const Render& render) {
        const auto tile = std::make_unique<EyeTile<Media>>(
            scene_, settings_, vpls, *selector_, transport_ ? &*transport_ : nullptr, packet,
            EyeShadowMaps{.lights = maps_ ? maps_->of_lights() : nullptr,
                          .receivers = store,
                          .imperfect = settings_.visibility.imperfect ? &imperfect_ : nullptr});
        render(*tile);
        const std::lock_guard lock(cost_mutex_);
        imperfect_lookups_ += tile->imperfect_lookups();
        tile->selector().add_statistics(selection_statistics_);
        cost_.vertices += tile->compensation_cost().vertices;
        cost_.seconds += tile->compensation_cost().seconds;
    }

    void store_compensation(const EyeTile<Media>& tile, const PacketPixels& pixels, PassImage& image) const {
        if (!settings_.compensates()) return;
        pixels.for_each([&](std::size_t lane, int x, int y) {
            for (std::size_t i = 0; i < (Media ? 2u : 1u); ++i)
                image.at(first_compensation_layer + i, x, y) =
                    tile.restored(lane)[i] / float(settings_.eye_paths());
        });
    }

    /// Those of VPLs, which are filtered and interpolated; what the screen-space compensation fills comes
    /// after that.
    std::vector<LayerFilter::Choice> vpl_layers() const {
        using screenspace::LayerKind;
        std::vector<LayerFilter::Choice> layers{{std::size_t(Transport::indirect), LayerKind::surface}};
        if (Media) layers.push_back({std::size_t(Transport::multiple_scattering), LayerKind::volume});
        if (!settings_.compensation.enabled) return layers;
        if (!settings_.screen_space) layers.push_back({first_compensation_layer, LayerKind::surface});
        if (Media) layers.push_back({first_compensation_layer + 1, LayerKind::volume});
        return layers;
    }

    const Scene& scene_;
    RenderOptions options_;
    VplSettings settings_;
    float bound_;
    ImageLoop<Media> loop_;
    std::unique_ptr<lights::VplSelector> selector_;  ///< of this pass
    Statistics selection_statistics_;
    std::optional<lights::ReflectiveShadowMaps> reflective_;  ///< nothing: lights sample their paths
    lights::SurfaceSamples points_;
    lights::ImperfectShadowMaps imperfect_;  ///< of this pass, from these points
    double imperfect_seconds_ = 0.0;
    std::uint64_t imperfect_lookups_ = 0;
    std::optional<compensation::ResidualTransport> transport_;  ///< nothing: no compensation
    std::optional<HiddenLight> hidden_;                         ///< nothing: one layer
    std::optional<VplShadowMaps> maps_;                         ///< nothing: visibility is traced
    std::optional<LayerFilter> filter_;                         ///< nothing: pixels stay as they are
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
