// An edge-preserving blur of irradiance: a bilateral Gaussian that stays on a surface (Engelhardt 2013,
// Sec. 11.3). It hides the blocks that thresholds far above the usual ones leave.
#pragma once

#include <span>
#include <vector>

#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::screenspace {

/// `deviation` of the Gaussian [pixels], cut off at twice that; pixels count less the more their surfaces
/// differ, and not at all from `angle` [rad] on. Pixels that take no part are left as they are, and out.
std::vector<core::Rgb> blurred(const SsbcSurfaces& surfaces, std::span<const core::Rgb> irradiance,
                               float deviation, float angle);

}  // namespace mote::screenspace
