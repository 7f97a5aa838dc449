// The second half of a pass of `mote_vpl` with shadow maps: all VPLs, in batches whose maps use the same
// memory again, add their light to the receivers that the eye paths left.
//
// Every pixel's sum is taken in the order of the VPLs by one task at a time, so neither threads nor the size
// of the batches change a bit of it.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include "core/render/integrator.h"
#include "integrators/virtual_point_lights/vpl_visibility.h"
#include "lights/shadow_maps/light_shadow_maps.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::integrators {

class VplShadowMaps {
  public:
    /// Builds the maps of the lights. Throws InputError when a map would be larger than its limit,
    /// OutOfMemory when all of them are larger than `memory`.
    VplShadowMaps(const core::Scene& scene, const VisibilitySettings& settings,
                  const core::MemoryBudget& memory);

    /// Null where lights are traced.
    const lights::LightShadowMaps* of_lights() const { return lights_ ? &*lights_ : nullptr; }

    /// Adds to the layers `indirect` and `multiple_scattering` of `image`. A pixel's receivers are all in one
    /// store. Returns false when it was cancelled half-way.
    bool add_light(const lights::VplSet& vpls, float bound, std::span<const lights::ReceiverStore> stores,
                   const std::atomic<bool>& cancelled, core::PassImage& image);
    void add_statistics(core::Statistics& statistics) const;

  private:
    struct Entry {
        std::size_t vpl;
        lights::ShadowMapView view;
    };
    void build(const lights::VplSet& vpls, std::span<const Entry> batch, core::CancelToken cancelled);
    void gather(const lights::VplSet& vpls, float bound, std::span<const Entry> batch,
                std::span<const lights::ReceiverStore> stores, core::CancelToken cancelled,
                core::PassImage& image);

    const core::Scene& scene_;
    VisibilitySettings settings_;
    std::optional<lights::LightShadowMaps> lights_;
    std::vector<lights::VolumetricShadowMap> maps_;
    std::uint64_t built_ = 0, lookups_ = 0;
    std::size_t receivers_ = 0, receiver_bytes_ = 0;
    double build_seconds_ = 0.0, gather_seconds_ = 0.0;
    core::RayCounters rays_;
};

}  // namespace mote::integrators
