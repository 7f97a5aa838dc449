// Trial passes that find how much effort each technique of `mote_upbp` is worth in a scene (efforts.h).
//
// They are none of the picture, and follow from scene, settings and seed alone: every pass of a render, on
// any number of threads, resumed or shared out, has the same efforts.
#pragma once

#include "integrators/upbp/upbp_passes.h"

namespace mote::integrators {

/// Traces some 8000 eye paths and as many light paths a pass, six passes; their rays are added to `counters`.
/// Throws Cancelled, and OutOfMemory.
template <bool Media>
PerTechnique efforts_by_trials(const core::Scene& scene, const core::RenderOptions& options,
                               const UpbpSettings& settings, SharedCounters& counters);

}  // namespace mote::integrators
