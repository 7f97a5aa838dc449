// A trial pass that finds what the merges of `mote_upbp` cost in a scene (merge_efforts.h).
//
// It is none of the picture, and follows from scene, settings and seed alone: every pass of a render, on any
// number of threads, resumed or shared out, has the same efforts.
#pragma once

#include "integrators/upbp/upbp_passes.h"

namespace mote::integrators {

/// Traces up to 16384 light paths, and eye paths for a quarter of them. Throws Cancelled, and OutOfMemory.
template <bool Media>
PerMerge efforts_by_trial(const core::Scene& scene, const core::RenderOptions& options,
                          const UpbpSettings& settings);

}  // namespace mote::integrators
