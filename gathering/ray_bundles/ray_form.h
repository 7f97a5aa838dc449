// A bundle by rays of Embree: packets of sixteen find the boxes of triangles that they pass, and the rule of
// ProjectedTriangle says which triangles they hit.
#pragma once

#include "core/geometry/box_hierarchy.h"
#include "gathering/ray_bundles/hit_band.h"
#include "gathering/ray_bundles/projected_triangle.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

class RayForm {
  public:
    static constexpr std::uint32_t packet_side = 4;  ///< a packet is 4 x 4 rays

    /// Keeps a reference to the triangles; `bounds` holds them all.
    RayForm(const SurfaceTriangles& triangles, const core::Bounds3& bounds);

    /// Rows [begin, end), at most packet_side of them. Safe from many threads.
    void trace_rows(const BundleGrid& grid, std::uint32_t begin, std::uint32_t end, HitBand& band) const;
    std::size_t memory_bytes() const { return boxes_.memory_bytes(); }

  private:
    const SurfaceTriangles& triangles_;
    core::Bounds3 bounds_;
    float margin_;  ///< around each triangle: more than rounding can move a ray or a box [m]
    core::BoxHierarchy boxes_;
};

}  // namespace mote::gathering
