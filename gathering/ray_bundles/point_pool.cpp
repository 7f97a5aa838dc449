#include "gathering/ray_bundles/point_pool.h"

#include <tbb/parallel_for.h>

namespace mote::gathering {

using namespace core;

PointPool::PointPool(const SurfaceTriangles& triangles, std::uint32_t points, std::uint32_t sets)
    : points_(points),
      sets_(sets),
      stride_((points + block - 1) / block * block),
      middle_(triangles.bounds.center()) {
    const SurfacePoints surface(triangles);
    area_ = surface.area();
    if (!(area_ > 0.0)) points_ = 0, stride_ = 0;
    values_.resize(std::size_t(columns) * stride_ * sets), triangles_.resize(stride_ * sets);
    if (points_ == 0) return;
    tbb::parallel_for(std::uint32_t(0), sets, [&](std::uint32_t set) {
        std::vector<SurfacePoint> sampled;
        surface.sample(set, points, 0, points, sampled);
        for (std::size_t i = 0; i < stride_; ++i) {
            const SurfacePoint& p = sampled[std::min(i, sampled.size() - 1)];  // the last fills the block
            const auto& c = triangles.corners[p.triangle];
            const Vec3d e1 = Vec3d(c[1]) - Vec3d(c[0]), e2 = Vec3d(c[2]) - Vec3d(c[0]),
                        cross = glm::cross(e1, e2);
            const double length_squared = glm::dot(cross, cross);
            const Vec3 center = Vec3(Vec3d(c[0]) - Vec3d(middle_) + double(p.u) * e1 + double(p.v) * e2);
            const Vec3 normal(cross / std::sqrt(length_squared));
            const Vec3 by_u(65535.0 * glm::cross(e2, cross) / length_squared);
            const Vec3 by_v(65535.0 * glm::cross(cross, e1) / length_squared);
            const float row[columns] = {center.x, center.y, center.z,       normal.x,      normal.y,
                                        normal.z, by_u.x,   by_u.y,         by_u.z,        by_v.x,
                                        by_v.y,   by_v.z,   65535.0f * p.u, 65535.0f * p.v};
            for (std::size_t k = 0; k < columns; ++k) values_[(set * columns + k) * stride_ + i] = row[k];
            triangles_[set * stride_ + i] = p.triangle;
        }
    });
}

}  // namespace mote::gathering
