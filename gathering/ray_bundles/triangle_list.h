// Triangles of one shape on their way into SurfaceTriangles.
#pragma once

#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

/// Adds the triangles of a shape to a list.
class TriangleList {
  public:
    /// Corner of a triangle.
    struct Corner {
        core::Vec3 position{0.0f};  ///< [m]
        core::Vec3 normal{0.0f};    ///< of any length; zero: that of the triangle
        core::Vec2 uv{0.0f};        ///< texture coordinates
    };
    TriangleList(SurfaceTriangles& list, std::uint32_t shape)
        : list_(list), shape_(shape) {}  ///< `shape`: its index among the scene's.

    /// The front is the side from which a, b, c run counter-clockwise; normals are turned to it.
    void add(const Corner& a, const Corner& b, const Corner& c, std::uint32_t primitive);

  private:
    SurfaceTriangles& list_;
    std::uint32_t shape_;
};

}  // namespace mote::gathering
