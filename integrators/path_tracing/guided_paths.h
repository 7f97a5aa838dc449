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

/// Traces the training paths; counters receive their rays. Throws Cancelled, and OutOfMemory.
template <bool Media>
std::unique_ptr<lights::LearnedGuide> train_guide(const core::Scene& scene,
                                                  const core::RenderOptions& options,
                                                  const PathSettings& settings, SharedCounters& counters);

/// Lets the guide decide what leaves least variance for the same counted work, by trial passes of all kinds
/// over the same pixels. False: unguided paths leave less. Depends on scene and seed alone. `work`: cost of a
/// guided ray in unguided ones.
template <bool Media>
bool choose_parts(const core::Scene& scene, const core::RenderOptions& options, const PathSettings& settings,
                  lights::LearnedGuide& guide, double work, SharedCounters& counters);

}  // namespace mote::integrators
