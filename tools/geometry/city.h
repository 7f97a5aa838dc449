// A town of blocks around a few towers, with trees along its streets: the scene of scenes/city.xml, standing
// for the procedural city of Engelhardt 2013, Fig. 10.13.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// 11 x 11 blocks of 60 m with their streets, centred on the origin; towers up to 190 m. About 820 000
/// triangles at detail 1; detail below 1 takes away blocks, above 1 adds some.
Parts make_city(float detail, std::uint64_t seed);

}  // namespace mote::tools
