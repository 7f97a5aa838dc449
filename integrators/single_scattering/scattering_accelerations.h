// Accelerations of the single-scattering integrators, made once for all passes: the tree of surfaces for
// exact integrals, and the shadow maps of the lights.
#pragma once

#include "core/render/plan.h"
#include "core/render/statistics.h"
#include "core/scene/requirements.h"
#include "lights/visibility/visibility.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::integrators {

struct AccelerationSettings {
    bool exact = true;                                     ///< integrals instead of steps, where there can be
    std::optional<lights::LightMapSettings> light_maps{};  ///< nothing: lights are traced
};

class ScatteringAccelerations {
  public:
    /// Makes only what the scene has a use for. Throws InputError when a map would be larger than its limit.
    ScatteringAccelerations(const core::Scene& scene, const AccelerationSettings& settings,
                            const core::MemoryBudget& memory);

    screenspace::MarchAccelerations of(const core::Emitter& light) const {
        return {space_ ? &*space_ : nullptr, maps_ ? maps_->of(light) : nullptr};
    }
    /// Null where lights are traced.
    const lights::LightShadowMaps* maps() const { return maps_ ? &*maps_ : nullptr; }
    void add_statistics(core::Statistics& statistics) const;

  private:
    std::optional<screenspace::UnoccludedSpace> space_;
    std::optional<lights::LightShadowMaps> maps_;
};

/// `steps` of a marched ray.
void plan_scattering_accelerations(core::Plan& plan, const core::Scene& scene,
                                   const AccelerationSettings& settings, int steps);

}  // namespace mote::integrators
