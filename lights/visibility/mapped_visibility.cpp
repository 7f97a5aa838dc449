#include "lights/visibility/mapped_visibility.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <optional>

#include "core/render/cpu_clock.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::lights {

using namespace core;

namespace {

class PreparedShadowMaps final : public PreparedVisibility {
  public:
    PreparedShadowMaps(const LitScene& scene, const MappedVisibilitySettings& settings,
                       const MemoryBudget& memory);
    void begin(const VisibilityPass& pass) override {
        stores_.clear(), stores_.resize(pass.tasks);
        pass.image.finish_late();
    }
    /// Stores the receivers. All of a pixel are in one store.
    TileLight gather(std::size_t task, const TileGather& g) override {
        stores_[task].add(g.receivers, g.column, g.row, g.spacing, g.range, g.light_scale);
        return {};
    }
    /// Adds to the layers `indirect` and `multiple_scattering`.
    bool finish(const VisibilityPass& pass) override;
    const LightShadowMaps* of_lights() const override { return lights_ ? &*lights_ : nullptr; }
    void add_statistics(Statistics& statistics) const override;

  private:
    struct Entry {
        std::size_t vpl;
        ShadowMapView view;
    };
    void build(const VisibilityPass& pass, std::span<const Entry> batch);
    void gather(const VisibilityPass& pass, std::span<const Entry> batch);

    const LitScene& scene_;
    MappedVisibilitySettings settings_;
    std::optional<LightShadowMaps> lights_;  ///< nothing: lights are traced
    std::vector<VolumetricShadowMap> maps_;
    std::vector<ReceiverStore> stores_;  ///< of the tasks of this pass
    std::uint64_t built_ = 0, lookups_ = 0;
    std::size_t receivers_ = 0, receiver_bytes_ = 0;
    double build_seconds_ = 0.0, gather_seconds_ = 0.0;
    RayCounters rays_;
};

PreparedShadowMaps::PreparedShadowMaps(const LitScene& scene, const MappedVisibilitySettings& settings,
                                       const MemoryBudget& memory)
    : scene_(scene), settings_(settings), maps_(std::size_t(settings.maps)) {
    for (const int edge : {settings.size, settings.lights.size}) check_map(scene, settings.lights, edge);
    require_shadow_maps(memory, settings.lights.map, maps_.size(), settings.size,
                        needs_chromatic_maps(scene));
    if (settings.lights.size == 0) return;
    const Stopwatch stopwatch(build_seconds_);
    lights_.emplace(scene, settings.lights.size, settings.lights.map, memory);
    built_ += lights_->count();
    rays_.add(lights_->rays());
}

bool PreparedShadowMaps::finish(const VisibilityPass& pass) {
    std::size_t bytes = 0;
    for (const ReceiverStore& store : stores_) receivers_ += store.receivers(), bytes += store.memory_bytes();
    receiver_bytes_ = std::max(receiver_bytes_, bytes);
    std::vector<Entry> batch;
    const auto finish_batch = [&] { build(pass, batch), gather(pass, batch), batch.clear(); };
    for (std::size_t j = 0; j < pass.vpls.lights.size(); ++j) {
        const VplViews views = views_of(pass.vpls, j, settings_.size);
        for (int side = 0; side < views.count; ++side) {
            batch.push_back({j, views.view[std::size_t(side)]});
            if (batch.size() < maps_.size()) continue;
            if (pass.cancelled) return false;
            finish_batch();
        }
    }
    if (!pass.cancelled) finish_batch();
    return !pass.cancelled;
}

void PreparedShadowMaps::build(const VisibilityPass& pass, std::span<const Entry> batch) {
    const Stopwatch stopwatch(build_seconds_);
    tbb::parallel_for(std::size_t(0), batch.size(), [&](std::size_t i) {
        const MediumState state = pass.vpls.state_towards(batch[i].vpl, batch[i].view.frame.n);
        maps_[i].build(scene_, batch[i].view, state, settings_.lights.map, pass.cancelled);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) rays_.add(maps_[i].rays());
    built_ += batch.size();
}

void PreparedShadowMaps::gather(const VisibilityPass& pass, std::span<const Entry> batch) {
    const Stopwatch stopwatch(gather_seconds_);
    const CancelToken cancelled = pass.cancelled;
    std::vector<MappedVpl> mapped;
    for (std::size_t i = 0; i < batch.size(); ++i) mapped.push_back({batch[i].vpl, &maps_[i]});
    tbb::enumerable_thread_specific<ShadowMapGather> gathers;
    tbb::parallel_for(std::size_t(0), stores_.size(), [&](std::size_t s) {
        cancelled.check();
        constexpr int side = 4;
        gathers.local().run(stores_[s], pass.vpls, BoundedGeometry{pass.bound}, mapped,
                            [&](const ReceiverStore::Tile& tile, int lane, const Rgb& light) {
                                const bool medium = tile.in_medium[lane] != 0.0f;
                                const auto layer =
                                    medium ? Transport::multiple_scattering : Transport::indirect;
                                pass.image.at(layer, tile.column + lane % side * tile.spacing,
                                              tile.row + lane / side * tile.spacing) += light;
                            });
    });
    for (const ShadowMapGather& g : gathers) lookups_ += g.lookups();
}

void PreparedShadowMaps::add_statistics(Statistics& statistics) const {
    std::size_t bytes = 0;
    for (const VolumetricShadowMap& map : maps_) bytes += map.memory_bytes();
    auto& values = statistics.values;
    values["shadow_maps_built"] += double(built_);
    values["shadow_map_bytes"] = double(bytes);
    values["light_shadow_map_bytes"] = lights_ ? double(lights_->memory_bytes()) : 0.0;
    values["receivers"] += double(receivers_);
    values["receiver_bytes_peak"] = double(receiver_bytes_);
    values["shadow_map_build_seconds"] += build_seconds_;
    values["shadow_map_gather_seconds"] += gather_seconds_;
    statistics.lookups["shadow_maps"] += lookups_;
    statistics.rays["closest"] += rays_.closest;
    statistics.rays["boundary"] += rays_.boundary;
}

}  // namespace

void check_map(const LitScene& scene, const LightMapSettings& settings, int edge) {
    try {
        if (edge > 0) settings.map.check(edge, needs_chromatic_maps(scene));
    } catch (const InputError& error) {
        throw InputError(error.what(), settings.where);
    }
}

std::unique_ptr<PreparedVisibility> prepare_mapped_visibility(const LitScene& scene,
                                                              const MappedVisibilitySettings& settings,
                                                              const MemoryBudget& memory) {
    return std::make_unique<PreparedShadowMaps>(scene, settings, memory);
}

}  // namespace mote::lights
