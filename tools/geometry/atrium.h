// An atrium of two storeys of vaulted arcades around a court that is open to the sky: the scene of
// scenes/atrium.xml, standing for the Crytek Sponza of Engelhardt 2013, Fig. 10.13.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// The court is 28 x 12 m around the origin, the building 36 x 20 m and 12.6 m high. About 262 000 triangles
/// at detail 1.
Parts make_atrium(float detail, std::uint64_t seed);

}  // namespace mote::tools
