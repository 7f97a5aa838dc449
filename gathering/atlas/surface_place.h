// A point of a triangle of the list as a hit on its shape.
#pragma once

#include "core/geometry/shape.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

/// Shapes in the order of the scene, which SurfaceTriangles counts them in.
using ShapeSpan = std::span<const std::shared_ptr<core::Shape>>;

/// The hit at (1 - u - v) c0 + u c1 + v c2. `t` and the rounding error of a ray are not known: leave it
/// through offset_origin(), whose error is taken from the triangle's size.
core::SurfaceHit surface_place(const SurfaceTriangles& surfaces, ShapeSpan shapes, std::uint32_t triangle,
                               const core::Vec2& barycentric);

/// Bound of the depth below a shape at which its triangles may lie: twice the chord error of tessellations,
/// for shapes that are no meshes [m]. Shadow rays meet the shape itself.
inline float depth_below(const core::Shape& shape) {
    constexpr float chord_error = TessellationSettings{}.chord_error;
    return shape.primitive_count() > 1 ? 0.0f
                                       : 2.0f * chord_error * core::max_component(shape.bounds().diagonal());
}

}  // namespace mote::gathering
