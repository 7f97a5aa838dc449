// Entries of mote_vpl's plan about bias compensation: what runs in a scene, and what is missing.
#pragma once

#include "compensation/compensation_settings.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

namespace mote::integrators {

/// `bound` is b [1/m^2].
void plan_compensation(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
                       const compensation::CompensationSettings& settings, float bound);

/// Expected relative energy loss of bounded VPLs in the media, with this compensation, and how many
/// light paths and which bound would leave out less (compensation/expected_loss.h).
void plan_expected_loss(core::Plan& plan, const core::Scene& scene,
                        const compensation::CompensationSettings& settings, float bound);

}  // namespace mote::integrators
