#include "gathering/ray_bundles/triangle_cull.h"

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/bundle_projection.h"

namespace mote::gathering {

using namespace core;

namespace {

/// One coordinate of a point on the grid: a . p + a0, in rays.
struct GridCoordinate {
    float x, y, z, start;
    float count;  ///< of rays along it
    float room;   ///< rounding of the four terms
    float at(float px, float py, float pz) const { return x * px + y * py + z * pz + start; }
};

/// The whole numbers in [0, count) between three values; none where first > last.
struct Between {
    float first, last;
    Between(float a, float b, float c, const GridCoordinate& g)
        : first(std::ceil(max_of(min_of(a, min_of(b, c)) - g.room, 0.0f))),
          last(std::floor(min_of(max_of(a, max_of(b, c)) + g.room, g.count - 1.0f))) {}
};

}  // namespace

TriangleCull::TriangleCull(const SurfaceTriangles& triangles, const Bounds3& bounds)
    : center_(bounds.center()) {
    reach_ = 0.5f * max_component(bounds.diagonal()) * 1.001f;
    for (std::size_t k = 0; k < 9; ++k) {
        coordinates_[k].resize(triangles.size());
        const int axis = int(k % 3);
        for (std::size_t i = 0; i < triangles.size(); ++i)
            coordinates_[k][i] = triangles.corners[i][k / 3][axis] - center_[axis];
    }
}

void TriangleCull::find(const BundleGrid& grid, std::size_t begin, std::size_t count, Rows& rows) const {
    const BundleProjection projection(grid);
    const Vec3d middle = projection(center_);
    const Vec3d dx = projection.vector(Vec3d(1, 0, 0)), dy = projection.vector(Vec3d(0, 1, 0)),
                dz = projection.vector(Vec3d(0, 0, 1));
    const auto coordinate = [&](int axis, std::uint32_t steps) {
        // One rounding of each product and sum, and those of the factors and of the center's difference.
        const double largest =
            double(reach_) * (std::fabs(dx[axis]) + std::fabs(dy[axis]) + std::fabs(dz[axis])) +
            std::fabs(middle[axis]);
        return GridCoordinate{float(dx[axis]),     float(dy[axis]), float(dz[axis]),
                              float(middle[axis]), float(steps),    float(largest * 0x1p-20)};
    };
    const GridCoordinate gx = coordinate(0, grid.columns), gy = coordinate(1, grid.rows);
    const float* c[9];
    for (std::size_t k = 0; k < 9; ++k) c[k] = coordinates_[k].data() + begin;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < int(count); ++i) {
        const Between x(gx.at(c[0][i], c[1][i], c[2][i]), gx.at(c[3][i], c[4][i], c[5][i]),
                        gx.at(c[6][i], c[7][i], c[8][i]), gx);
        const Between y(gy.at(c[0][i], c[1][i], c[2][i]), gy.at(c[3][i], c[4][i], c[5][i]),
                        gy.at(c[6][i], c[7][i], c[8][i]), gy);
        rows.first[i] = int(y.first);
        rows.last[i] = x.first > x.last ? -1 : int(y.last);
    }
}

}  // namespace mote::gathering
