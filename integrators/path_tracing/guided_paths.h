// Training of guided paths: passes 1, 2, 4, ... of paths, which are themselves guided by what was learned
// before.
//
// Training paths are none of the picture. Their random numbers follow from seed, pass and path number alone,
// and their samples are learned in that order: the field depends on scene and seed, not on threads, and a
// render that is resumed or shared out learns it again. Passes of the picture then are as independent of each
// other as unguided ones.
#pragma once

#include <memory>

#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/trace_paths.h"
#include "lights/guiding/learned_guide.h"

namespace mote::integrators {

/// Traces the training paths; counters receive their rays. With Guiding::automatic, null where trials find
/// that the guide does not pay (GuidingTrials): after a quarter of the training, which then ends, or after
/// it. `ray_work`: cost of a guided ray in unguided ones. Throws Cancelled, and OutOfMemory.
template <bool Media>
std::unique_ptr<lights::LearnedGuide> train_guide(const core::Scene& scene,
                                                  const core::RenderOptions& options,
                                                  const PathSettings& settings, double ray_work,
                                                  SharedCounters& counters);

}  // namespace mote::integrators
