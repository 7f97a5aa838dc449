// Sets of points on surfaces, sampled once, with what a disc around each needs: read in order, eight at a
// time.
#pragma once

#include <array>

#include "gathering/ray_bundles/surface_points.h"

namespace mote::gathering {

class PointPool {
  public:
    /// A coordinate of the points of one set, one after the other.
    enum Column : std::uint8_t {
        center_x,
        center_y,
        center_z,  ///< from the middle of the bounds [m]
        normal_x,
        normal_y,
        normal_z,  ///< unit, of the triangle
        grow_u_x,
        grow_u_y,
        grow_u_z,  ///< how u grows along the triangle's plane, in units of 1 / 65535 [1/m]
        grow_v_x,
        grow_v_y,
        grow_v_z,
        u,
        v,  ///< of the point, in units of 1 / 65535
        columns
    };

    PointPool(const SurfaceTriangles& triangles, std::uint32_t points, std::uint32_t sets);

    std::uint32_t points() const { return points_; }  ///< of each set; 0 where there is no area
    std::uint32_t sets() const { return sets_; }
    double area() const { return area_; }  ///< of the surfaces [m^2]
    const core::Vec3& middle() const { return middle_; }
    const float* column(std::uint32_t set, Column c) const {
        return values_.data() + (std::size_t(set) * columns + c) * stride_;
    }
    const std::uint32_t* triangles(std::uint32_t set) const {
        return triangles_.data() + std::size_t(set) * stride_;
    }
    std::size_t memory_bytes() const { return values_.capacity() * sizeof(float) * (columns + 1) / columns; }

    /// Columns may be read up to a whole number of these.
    static constexpr std::uint32_t block = 64;

  private:
    std::uint32_t points_, sets_;
    std::size_t stride_;
    double area_;
    core::Vec3 middle_;
    std::vector<float> values_;
    std::vector<std::uint32_t> triangles_;
};

}  // namespace mote::gathering
