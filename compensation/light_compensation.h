// Compensation from the primary lights: light that scatters once more, inside the bounding region.
//
// L in Eq. 10.11 is the light that z reflects: of the primary lights (here), of the VPLs
// (vpl_compensation.h), and the compensation of both at z, which is the next step of the same walk
// (Engelhardt 2013, Sec. 10.3 computes the two apart). Emission at z itself is not in L: rays that collected
// it would count direct light twice.
#pragma once

#include "compensation/residual_transport.h"
#include "core/scene/lit_scene.h"

namespace mote::compensation {

/// Light of the primary lights, over `steps` steps at most (-1: no limit), at the receiver that `path` starts
/// from, times the path's weights. Samples from context.rng; counts vertices, rays and tracking.
template <bool Media>
core::Rgb compensation_from_lights(const core::LitScene& scene, const ResidualTransport& transport,
                                   ResidualPath path, int steps, core::WalkContext& context,
                                   std::uint64_t& vertices);

}  // namespace mote::compensation
