// Entries of a plan about bias compensation: what runs in a scene, and what is missing.
#pragma once

#include "compensation/compensation_settings.h"
#include "core/render/plan.h"
#include "core/scene/requirements.h"
#include "core/scene/scene.h"

namespace mote::compensation {

/// `bound` is b [1/m^2].
void plan_compensation(core::Plan& plan, const core::Scene& scene, const core::Requirements& requirements,
                       const CompensationSettings& settings, float bound);

/// Expected relative energy loss of bounded VPLs in the media after so many steps of compensation (-1: all),
/// and how many light paths and which bound would leave out less (expected_loss.h).
void plan_expected_loss(core::Plan& plan, const core::Scene& scene, int steps, float bound);

}  // namespace mote::compensation
