#include "integrators/virtual_point_lights/vpl_shadow_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>

#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

using namespace core;
using lights::MappedVpl, lights::ReceiverStore, lights::ShadowMapGather, lights::VplSet;

namespace {

class Stopwatch {
  public:
    explicit Stopwatch(double& sum) : sum_(sum) {}
    ~Stopwatch() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

  private:
    double& sum_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

VplShadowMaps::VplShadowMaps(const Scene& scene, const VisibilitySettings& settings,
                             const MemoryBudget& memory)
    : scene_(scene), settings_(settings), maps_(std::size_t(settings.maps)) {
    settings.check(scene);
    lights::require_shadow_maps(memory, settings.map, maps_.size(), settings.size,
                                lights::needs_chromatic_maps(scene));
    if (settings.light_size == 0) return;
    const Stopwatch stopwatch(build_seconds_);
    lights_.emplace(scene, settings.light_size, settings.map, memory);
    built_ += lights_->count();
    rays_.add(lights_->rays());
}

bool VplShadowMaps::add_light(const VplSet& vpls, float bound, std::span<const ReceiverStore> stores,
                              const std::atomic<bool>& cancelled, PassImage& image) {
    std::size_t bytes = 0;
    for (const ReceiverStore& store : stores) receivers_ += store.receivers(), bytes += store.memory_bytes();
    receiver_bytes_ = std::max(receiver_bytes_, bytes);
    std::vector<Entry> batch;
    const auto finish_batch = [&] {
        build(vpls, batch, cancelled);
        gather(vpls, bound, batch, stores, cancelled, image);
        batch.clear();
    };
    for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
        const lights::VplViews views = lights::views_of(vpls, j, settings_.size);
        for (int side = 0; side < views.count; ++side) {
            batch.push_back({j, views.view[std::size_t(side)]});
            if (batch.size() < maps_.size()) continue;
            if (cancelled) return false;
            finish_batch();
        }
    }
    if (!cancelled) finish_batch();
    return !cancelled;
}

void VplShadowMaps::build(const VplSet& vpls, std::span<const Entry> batch, CancelToken cancelled) {
    const Stopwatch stopwatch(build_seconds_);
    tbb::parallel_for(std::size_t(0), batch.size(), [&](std::size_t i) {
        const MediumState state = vpls.state_towards(batch[i].vpl, batch[i].view.frame.n);
        maps_[i].build(scene_, batch[i].view, state, settings_.map, cancelled);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) rays_.add(maps_[i].rays());
    built_ += batch.size();
}

void VplShadowMaps::gather(const VplSet& vpls, float bound, std::span<const Entry> batch,
                           std::span<const ReceiverStore> stores, CancelToken cancelled, PassImage& image) {
    const Stopwatch stopwatch(gather_seconds_);
    std::vector<MappedVpl> mapped;
    for (std::size_t i = 0; i < batch.size(); ++i) mapped.push_back({batch[i].vpl, &maps_[i]});
    tbb::enumerable_thread_specific<ShadowMapGather> gathers;
    tbb::parallel_for(std::size_t(0), stores.size(), [&](std::size_t s) {
        cancelled.check();
        constexpr int side = 4;
        gathers.local().run(stores[s], vpls, lights::BoundedGeometry{bound}, mapped,
                            [&](const ReceiverStore::Tile& tile, int lane, const Rgb& light) {
                                const bool medium = tile.in_medium[lane] != 0.0f;
                                const auto layer =
                                    medium ? Transport::multiple_scattering : Transport::indirect;
                                image.at(std::size_t(layer), tile.column + lane % side * tile.spacing,
                                         tile.row + lane / side * tile.spacing) += light;
                            });
    });
    for (const ShadowMapGather& g : gathers) lookups_ += g.lookups();
}

void VplShadowMaps::add_statistics(Statistics& statistics) const {
    std::size_t bytes = 0;
    for (const lights::VolumetricShadowMap& map : maps_) bytes += map.memory_bytes();
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

}  // namespace mote::integrators
