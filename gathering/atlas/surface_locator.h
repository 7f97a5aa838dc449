// From a hit of the ray tracer to the triangle of the list, and the place in it.
#pragma once

#include <optional>

#include "core/math/kd_tree.h"
#include "gathering/atlas/surface_atlas.h"

namespace mote::gathering {

/// A place on a triangle of the list.
struct TrianglePlace {
    std::uint32_t triangle;  ///< of SurfaceTriangles
    float u, v;              ///< barycentric, of the second and third corner
};

/// Finds triangles of a list for hits of a ray tracer.
class SurfaceLocator {
  public:
    /// `surfaces` must outlive the locator.
    explicit SurfaceLocator(const SurfaceTriangles& surfaces);

    /// Returns nothing where the shape has no triangles in the list. Shapes that are no meshes have many
    /// triangles for one primitive: of the eight nearest that whose plane is nearest holds.
    std::optional<TrianglePlace> find(const core::SurfaceHit& hit) const;

  private:
    std::optional<TrianglePlace> place(std::uint32_t triangle, const core::Vec3& p) const;

    struct Shape {
        std::uint32_t first = 0, count = 0;  ///< triangles in by_primitive_
        bool one_each = true;                ///< primitive i is the i-th of them
        std::uint32_t tree = 0;              ///< else: of its middles
    };
    const SurfaceTriangles& surfaces_;
    std::vector<Shape> shapes_;
    std::vector<std::uint32_t> by_primitive_;
    std::vector<core::KdTree> trees_;
};

}  // namespace mote::gathering
