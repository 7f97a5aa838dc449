// Warning of ray lights in media so dense that few points of a line lie where light is.
#pragma once

#include "core/render/plan.h"
#include "core/scene/scene.h"

namespace mote::integrators {

/// Largest optical depth of one cell of a line, over the scene's media that vary and scatter.
double thickest_cell(const core::Scene& scene);

/// Largest optical depth across a medium that glows.
double thickest_glow(const core::Scene& scene);

/// Warns where cells are optically thick. Within a cell distances are not sampled by transmittance: of the
/// optical depth m of a cell through which light enters, one unit is lit, which a point on the ray light and
/// one on the eye ray meet with a probability of 1 / m^2. Of light that a medium emits evenly, 1 / m begins
/// where it leaves the medium.
void plan_thick_cells(core::Plan& plan, const core::Scene& scene);

}  // namespace mote::integrators
