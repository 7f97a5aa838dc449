// Walls with windows that lie back in their openings, and what buildings are made of with them.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// One wall with rows of windows. Widths and heights are fractions of a cell of the grid.
struct Facade {
    Vec3 foot, along;  ///< lower left corner, and to the right: its length is the width [m]
    float height;
    int floors, columns;
    float window_width = 0.5f, window_height = 0.55f, recess = 0.18f;
};
/// 10 triangles a window, 4 a floor and column of wall.
void add_facade(Soup& wall, Soup& glass, const Facade& facade);

/// Style shared by a building's four walls.
struct Style {
    std::string wall;  ///< the part that the walls go to
    float storey = 3.2f, cell = 3.0f, window_width = 0.5f, window_height = 0.55f, recess = 0.18f;
};
/// Four facades around an upright box, without a roof. The box stands on lower.y.
void add_walls(Parts& parts, const Style& style, const Vec3& lower, const Vec3& upper);
/// A flat roof with a parapet, and a hut, tanks and boxes on it as there is space.
void add_flat_roof(Parts& parts, const std::string& wall, const Vec3& lower, const Vec3& upper,
                   std::uint64_t seed);
/// A hipped roof with a chimney.
void add_hipped_roof(Parts& parts, const std::string& wall, const Vec3& lower, const Vec3& upper, float rise);

}  // namespace mote::tools
