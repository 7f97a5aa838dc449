// Marching through voxels that are optically thick: steps miss where they begin.
#pragma once

#include "core/render/plan.h"
#include "core/scene/scene.h"

namespace mote::integrators {

/// Optical depths beyond this in one step: the middle of a step says too little of the step.
inline constexpr double thick_step = 4.0;

/// Largest optical depth of one marching step of `voxels` voxels, over the scene's media; 0 where none
/// varies.
double depth_of_marching_step(const core::Scene& scene, float voxels);

/// Warns where steps are optically thicker than that.
void plan_coarse_voxels(core::Plan& plan, const core::Scene& scene, float voxels);

}  // namespace mote::integrators
