// A round temple without a roof, for a statue in its middle: the scene of scenes/statue.xml.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// Columns 9 m high on a circle of 13 m radius under a ring of beams, steps, paving, and a pedestal 2.6 m
/// high in the middle. Parts "stone", "wall", "red", "marble".
Parts make_rotunda(float detail, std::uint64_t seed);

}  // namespace mote::tools
