// Turned and cast things that furnish the atrium: pots, a fountain, lanterns, rods.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// A terracotta pot on the origin, 0.8 m high, filled with soil up to pot_soil().
Soup make_pot(float detail);
float pot_soil();
/// A bar of eight sides.
Soup make_rod(const Vec3& a, const Vec3& b, float radius);
/// A basin with two bowls, 2.9 m high: parts "marble" and "water".
void add_fountain(Parts& parts, const Vec3& foot, float detail);
/// A lantern that hangs `drop` below `hook`: parts "bronze" and "glow" (its glass).
void add_lantern(Parts& parts, const Vec3& hook, float drop, float detail);

}  // namespace mote::tools
