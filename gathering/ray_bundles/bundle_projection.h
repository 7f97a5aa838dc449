// Where points of the scene lie as a bundle's rays see them.
#pragma once

#include "gathering/ray_bundles/bundle_grid.h"

namespace mote::gathering {

/// Gives x and y in rays, so that ray (i, j) is at (i, j), and z, the distance along the rays [m]. In double
/// precision and by a fixed order of operations: equal corners of two triangles stay equal.
class BundleProjection {
  public:
    explicit BundleProjection(const BundleGrid& grid) : origin_(grid.origin) {
        const core::Vec3d x = double(grid.spacing) * core::Vec3d(grid.right),
                          y = double(grid.spacing) * core::Vec3d(grid.up), z(grid.direction);
        // The dual basis: x, y and z are at right angles to rounding only.
        const double volume = glm::dot(x, glm::cross(y, z));
        x_ = glm::cross(y, z) / volume, y_ = glm::cross(z, x) / volume, z_ = glm::cross(x, y) / volume;
    }
    core::Vec3d operator()(const core::Vec3& p) const {
        const core::Vec3d d = core::Vec3d(p) - origin_;
        return {glm::dot(x_, d) - 0.5, glm::dot(y_, d) - 0.5, glm::dot(z_, d)};
    }
    /// Components of a vector on the grid.
    core::Vec3d vector(const core::Vec3d& v) const {
        return {glm::dot(x_, v), glm::dot(y_, v), glm::dot(z_, v)};
    }

  private:
    core::Vec3d origin_, x_, y_, z_;
};

}  // namespace mote::gathering
