// Limits of an eye path: its length, and the cells of the transport that it is for.
#pragma once

#include <algorithm>
#include <limits>

#include "integrators/eye_path/light_samples.h"
#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

struct EyePathLimits {
    int max_depth = -1;            ///< edges of a path: 1 emission only, 2 direct light; -1 no limit
    int rr_depth = 5;              ///< Russian roulette from this depth on
    int max_scatterings = -1;      ///< but at mirrors and glass; -1 no limit
    bool hide_emitters = false;    ///< eye rays pass area lights and do not see the environment
    LightSamples light_samples{};  ///< of next-event estimation
    TransportSet wanted = TransportSet::all();  ///< paths end where no more of it can be found

    /// Depth of the deepest virtual lights that a path of so many edges may be connected to.
    std::int32_t light_depth(int depth) const {
        return max_depth < 0 ? std::numeric_limits<std::int32_t>::max() : std::max(0, max_depth - depth - 1);
    }
};

}  // namespace mote::integrators
