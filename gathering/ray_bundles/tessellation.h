// Spheres, cylinders and disks cut into triangles.
//
// Shape::sample_area() maps the unit square to the surface: on all three continuously, so that a grid on the
// square is a grid on the surface.
#pragma once

#include <vector>

#include "gathering/ray_bundles/triangle_list.h"

namespace mote::gathering {

/// Where the unit square is cut.
struct Tessellation {
    std::vector<float> xs, ys;  ///< ascending, from 0 to 1
    std::size_t triangles() const { return 2 * (xs.size() - 1) * (ys.size() - 1); }  ///< at most
};

/// So fine that no triangle lies further off the surface than this fraction of the shape's extent.
Tessellation tessellation_of(const core::Shape& shape, float chord_error);

/// Corners lie on the surface, borders that meet share theirs to the bit; triangles without area are left
/// out.
void append_tessellated(const core::Shape& shape, const Tessellation& tessellation, TriangleList& list);

}  // namespace mote::gathering
