// Solid angles of texels, exact up to rounding in double precision.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace mote::tools {

/// Axis-parallel, from low to high.
struct Rectangle {
    glm::dvec2 low, high;
};

/// Solid angle [sr] of the convex spherical polygon between the directions `corners`, which need not have
/// unit length and must lie within one hemisphere (Oosterom & Strackee 1983).
double spherical_polygon(std::span<const core::Vec3d> corners);

/// Solid angle [sr] of a convex polygon on the unfolded octahedron [-1, 1]^2 (core/math/octahedral.h), whose
/// height is 1 / up: the creases of the octahedron cut it into pieces, which are spherical polygons.
double octahedral_polygon(std::span<const glm::dvec2> corners, double up);

/// Solid angle [sr] of a rectangle on the face [-1, 1]^2 of the cube.
double cube_rectangle(const Rectangle& r);

/// Integrals over the part of a rectangle that lies within the unit disc.
double disc_area(const Rectangle& r);
/// int 4 / (1 + x^2 + y^2)^2: the solid angle of what a mirror paraboloid shows there.
double paraboloid_rectangle(const Rectangle& r);

}  // namespace mote::tools
