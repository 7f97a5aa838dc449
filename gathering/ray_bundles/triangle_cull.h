// Triangles that fall between all rays of a grid, found quickly: most of them, where many fall on each ray.
//
// In single precision, eight triangles at a time, and conservative for its rounding: a triangle that is
// culled falls between the rays for certain.
#pragma once

#include "gathering/ray_bundles/bundle_grid.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

class TriangleCull {
  public:
    static constexpr std::size_t block = 256;  ///< triangles that one call tests

    /// Keeps the corners by coordinate, 36 bytes a triangle.
    TriangleCull(const SurfaceTriangles& triangles, const core::Bounds3& bounds);

    /// The rows first..last of the grid in which a triangle can have hits; none where first > last.
    struct Rows {
        std::int32_t first[block], last[block];
    };
    /// Rows of `count` triangles from `begin` on, at most a block.
    void find(const BundleGrid& grid, std::size_t begin, std::size_t count, Rows& rows) const;
    std::size_t size() const { return coordinates_[0].size(); }
    std::size_t memory_bytes() const { return 9 * coordinates_[0].capacity() * sizeof(float); }

  private:
    core::Vec3 center_{0.0f};
    float reach_ = 0.0f;  ///< of the corners from the center, along an axis [m]
    std::array<std::vector<float>, 9>
        coordinates_;  ///< x, y, z of the first corner, ...; from the center [m]
};

}  // namespace mote::gathering
