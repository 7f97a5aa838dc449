// Paths as the unbiased estimate of all light of a scene: where a scene chooses its methods, and for control
// passes (core/render/control_passes.h) of methods that are biased, or whose pixels err alike.
#pragma once

#include <memory>

#include "core/render/integrator.h"
#include "core/scene/scene.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

/// True where a lamp stands in a medium that scatters: light at collisions close to it has no finite
/// variance, since the density of collisions does not follow 1/d^2.
bool lamps_in_media(const core::Scene& scene);

/// Paths with all light within these limits, whose number of scatterings is not limited.
std::shared_ptr<const core::Integrator> unbiased_paths(const core::Scene& scene, EyePathLimits limits);

/// Lets control passes of unbiased_paths() show the error, where the passes of the method do not; or states
/// why they do not show it either.
void plan_control(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
                  const EyePathLimits& limits);

}  // namespace mote::integrators
