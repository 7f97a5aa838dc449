// Limits of an eye path: its length, and the cells of the transport that it is for.
#pragma once

#include "integrators/eye_path/transport_layers.h"

namespace mote::integrators {

struct EyePathLimits {
    int max_depth = -1;          ///< edges of a path: 1 emission only, 2 direct light; -1 no limit
    int rr_depth = 5;            ///< Russian roulette from this depth on
    int max_scatterings = -1;    ///< but at mirrors and glass; -1 no limit
    bool hide_emitters = false;  ///< eye rays pass area lights and do not see the environment
    TransportSet wanted = TransportSet::all();  ///< paths end where no more of it can be found
};

}  // namespace mote::integrators
