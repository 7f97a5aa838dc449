// Light paths that fit the limits of the eye paths they are joined to.
#pragma once

#include "integrators/eye_path/eye_path_limits.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::integrators {

/// Settings of `paths` light paths. `edges`: those of a whole path that are not between its light and the
/// last vertex of its light path, 2 for a virtual light that a receiver of the eye is connected to, 1 for a
/// photon at that receiver.
inline lights::LightPathSettings light_path_settings(std::uint32_t paths, const EyePathLimits& eye,
                                                     const core::MemoryBudget& memory, int edges = 2) {
    lights::LightPathSettings s;
    s.memory = memory, s.paths = paths, s.rr_depth = eye.rr_depth;
    s.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - edges);
    return s;
}

}  // namespace mote::integrators
