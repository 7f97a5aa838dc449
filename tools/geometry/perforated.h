// Thin sheets with many holes, through which a light falls apart into shafts: a carved screen, a lantern, and
// a tree in leaf. They represent the hole-rich occluders of Engelhardt 2013, chapter 9.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// A sheet of nu x nv cells over the unit square, each with a star-shaped hole, large and small in turn.
/// `point` places it: the third argument is 0 on the front and 1 on the back of the sheet. A cell has
/// 48 `steps` triangles.
void add_perforated(Soup& soup, int nu, int nv, int steps,
                    const std::function<Vec3(float u, float v, float depth)>& point);

/// A screen 6 x 4.5 m and 3 cm thick between two posts, standing on y = 0 and facing +z: parts "screen" and
/// "stone". About 310 000 triangles at detail 1.
Parts make_screen(float detail, std::uint64_t seed);
/// A lantern of radius 0.5 around the origin, hanging from a rod: parts "shell" and "rod". About 260 000
/// triangles at detail 1.
Parts make_lantern(float detail, std::uint64_t seed);
/// A tree 9 m high on the origin: parts "bark" and "leaves". About 300 000 triangles at detail 1.
Parts make_lone_tree(float detail, std::uint64_t seed);

}  // namespace mote::tools
