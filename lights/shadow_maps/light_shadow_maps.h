// Volumetric shadow maps of the lights themselves, built once: of point and spot lights and of parallel
// light, whose maps serve every vertex in a medium. Lights with an extent have no one point to map from.
#pragma once

#include <map>

#include "core/objects/memory_budget.h"
#include "core/scene/lit_scene.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"

namespace mote::lights {

class LightShadowMaps {
  public:
    /// Throws InputError when a map would be larger than settings.max_bytes, OutOfMemory when all of them
    /// exceed the budget. Lights that are not given a map are traced.
    LightShadowMaps(const core::LitScene& scene, int size, const ShadowMapSettings& settings,
                    const core::MemoryBudget& memory = {});

    /// Null: none for this light.
    const VolumetricShadowMap* of(const core::Emitter& emitter) const {
        const auto it = maps_.find(&emitter);
        return it == maps_.end() ? nullptr : &it->second;
    }
    std::size_t count() const { return maps_.size(); }
    std::size_t memory_bytes() const;
    core::RayCounters rays() const;

  private:
    std::map<const core::Emitter*, VolumetricShadowMap> maps_;
};

/// The view of a light that can have a map: a point, a cone, or parallel light; nothing for all others.
std::optional<ShadowMapView> shadow_map_view_of(const core::LitScene& scene, const core::Emitter& emitter,
                                                int size);

}  // namespace mote::lights
