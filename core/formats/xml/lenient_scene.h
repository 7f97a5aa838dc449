// --lenient: a scene with faults becomes one without them.
#pragma once

#include <string>
#include <vector>

#include "core/formats/xml/faults.h"
#include "core/objects/registry.h"

namespace mote::core {

/// Takes out of `scene` what `faults` name, or puts the nearest thing in its place: a grey diffuse for a
/// BSDF, volpath for an integrator, the usual sensor, film and sampler; everything else is left out, and
/// values are ignored, so that defaults hold. What is then missing elsewhere is the next round's fault.
/// Returns a line for each: what was wrong, and what was done.
std::vector<std::string> remedy(Element& scene, const Faults& faults, const Registry& registry);

}  // namespace mote::core
