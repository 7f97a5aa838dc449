// A thick wall with three barred, arched windows, and a pot before it: the scene of scenes/window.xml.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// The wall spans x from -4 to 4 and y from 0 to 4.4 around z = 0, the room lies at z > 0. Parts "wall",
/// "stone", "red", "iron", "terracotta", "leaves".
Parts make_window(float detail, std::uint64_t seed);

}  // namespace mote::tools
