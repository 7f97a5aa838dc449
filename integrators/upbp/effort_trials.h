// A trial that measures what the merges of `mote_upbp` bring and cost in a scene (effort_choice.h).
//
// It is none of the picture, and follows from scene, settings and seed alone: every pass of a render, on any
// number of threads, resumed or shared out, has the same efforts.
#pragma once

#include "integrators/upbp/effort_choice.h"
#include "integrators/upbp/upbp_passes.h"

namespace mote::integrators {

/// Kernels of a trial are those of this pass: as a picture of some dozens of passes has them.
inline constexpr std::uint32_t trial_pass = 8;

/// Traces up to 8192 light paths, and eye paths for some of them, a dozen times. Throws Cancelled, and
/// OutOfMemory.
template <bool Media>
Trial trial_of_efforts(const core::Scene& scene, const core::RenderOptions& options,
                       const UpbpSettings& settings);

}  // namespace mote::integrators
