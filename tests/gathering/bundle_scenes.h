// Surfaces for bundles, without a scene around them.
#pragma once

#include <cmath>

#include "gathering/ray_bundles/bundle_tracer.h"

namespace mote::tests {

/// Triangles with flat normals.
class TriangleBuilder {
  public:
    TriangleBuilder& triangle(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c,
                              std::uint32_t shape = 0) {
        const core::Vec3 cross = glm::cross(b - a, c - a);
        const float length = glm::length(cross);
        const core::Vec3 n = length > 0.0f ? cross / length : core::Vec3(0, 0, 1);
        list_.corners.push_back({a, b, c}), list_.normals.push_back({n, n, n});
        list_.uvs.push_back({core::Vec2(0, 0), core::Vec2(1, 0), core::Vec2(0, 1)});
        list_.shape.push_back(shape);
        list_.primitive.push_back(std::uint32_t(list_.primitive.size()));
        for (const core::Vec3& p : {a, b, c}) list_.bounds.extend(p);
        return *this;
    }
    /// a, b, c, d run counter-clockwise as seen from the front.
    TriangleBuilder& quad(const core::Vec3& a, const core::Vec3& b, const core::Vec3& c, const core::Vec3& d,
                          std::uint32_t shape = 0) {
        return triangle(a, b, c, shape).triangle(a, c, d, shape);
    }
    /// Six sides, shapes `first` (x = lower) to `first` + 5 (z = upper). `inwards`: a room.
    TriangleBuilder& box(const core::Vec3& lower, const core::Vec3& upper, bool inwards,
                         std::uint32_t first = 0) {
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const int j = (axis + 1) % 3, k = (axis + 2) % 3;
                core::Vec3 p[4];
                for (int i = 0; i < 4; ++i) {
                    p[i][axis] = side ? upper[axis] : lower[axis];
                    p[i][j] = i == 1 || i == 2 ? upper[j] : lower[j];
                    p[i][k] = i >= 2 ? upper[k] : lower[k];
                }
                const std::uint32_t shape = first + std::uint32_t(2 * axis + side);
                if ((side == 1) != inwards)
                    quad(p[0], p[1], p[2], p[3], shape);
                else
                    quad(p[3], p[2], p[1], p[0], shape);
            }
        return *this;
    }
    const gathering::SurfaceTriangles& list() const { return list_; }

  private:
    gathering::SurfaceTriangles list_;
};

}  // namespace mote::tests
