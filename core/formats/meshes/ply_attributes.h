// Properties of a PLY element that make attributes of the mesh, by Mitsuba's names.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace mote::core {

struct PlyColumn {
    std::string name;
    double largest;  ///< value of an integer type; 0 for real numbers, lists, and what is used otherwise
    bool free;       ///< not used otherwise, and no list
};

struct PlyAttribute {
    std::string name;                    ///< "vertex_color"
    std::array<std::size_t, 3> columns;  ///< all the same where there is one number
    double factor;                       ///< of colours given as integers: 1 / largest
};

/// `prefix` is "vertex_" or "face_". r, g, b or red, green, blue are "color"; foo_r, foo_g, foo_b are
/// "foo_color"; three or one of foo_x, foo_y, ... are "foo". Others are left out, as Mitsuba does.
std::vector<PlyAttribute> find_ply_attributes(std::span<const PlyColumn> columns, const std::string& prefix);

}  // namespace mote::core
