#include "gathering/ray_bundles/splats.h"

#include <algorithm>
#include <cmath>

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/bundle_projection.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr int lanes = SplatBlock::lanes;

/// Grid in single precision, with its origin in the middle of the surfaces.
struct GridAxes {
    Vec3 right, up, along, shift;  ///< shift: the middle on the grid
    float spacing, reach;          ///< reach: radius of a disc [rays]
    float rows;
};

float clamped(float x, float lower, float upper) { return min_of(max_of(x, lower), upper); }

struct Columns {
    const float* of[PointPool::columns];
    Vec3 vector(std::size_t first, int i) const { return {of[first][i], of[first + 1][i], of[first + 2][i]}; }
};

void make_block(const Columns& c, const std::uint32_t* triangles, int count, const GridAxes& g,
                SplatBlock& out) {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lanes; ++i) {
        const Vec3 center = c.vector(PointPool::center_x, i), n = c.vector(PointPool::normal_x, i);
        const float right = glm::dot(n, g.right), up = glm::dot(n, g.up), across = glm::dot(n, g.along);
        const bool on_edge = across * across <= 1e-10f;
        const float along = on_edge ? 1.0f : across;
        const float alpha = right / along, beta = up / along, s = g.spacing;
        const float y = glm::dot(center, g.up) / s + g.shift.y;
        // a dx^2 + 2 b dx dy + c dy^2 <= reach^2, where b = alpha beta, c = 1 + beta^2.
        const float a = 1.0f + alpha * alpha, inverse_a = 1.0f / a;
        out.x[i] = glm::dot(center, g.right) / s + g.shift.x, out.y[i] = y;
        out.lean[i] = -alpha * beta * inverse_a;
        out.width[i] = g.reach * g.reach * inverse_a;
        out.narrowing[i] = (a + beta * beta) * inverse_a * inverse_a;
        out.distance.at[i] = glm::dot(center, g.along) + g.shift.z;
        out.distance.by_x[i] = -s * alpha, out.distance.by_y[i] = -s * beta;
        const Vec3 by_x = s * (g.right - alpha * g.along), by_y = s * (g.up - beta * g.along);
        const Vec3 grow_u = c.vector(PointPool::grow_u_x, i), grow_v = c.vector(PointPool::grow_v_x, i);
        out.u.at[i] = c.of[PointPool::u][i], out.u.by_x[i] = glm::dot(grow_u, by_x),
        out.u.by_y[i] = glm::dot(grow_u, by_y);
        out.v.at[i] = c.of[PointPool::v][i], out.v.by_x[i] = glm::dot(grow_v, by_x),
        out.v.by_y[i] = glm::dot(grow_v, by_y);
        const float height = g.reach * std::sqrt(max_of(0.0f, 1.0f - up * up));
        out.first_row[i] = std::int32_t(std::ceil(clamped(y - height, 0.0f, g.rows)));
        const auto last = std::int32_t(std::floor(clamped(y + height, -1.0f, g.rows - 1.0f)));
        const bool none = on_edge | (i >= count);
        out.last_row[i] = none ? -1 : last;
        out.triangle[i] = triangles[i] | (across > 0.0f ? BundleHit::behind_bit : 0u);
    }
}

}  // namespace

void make_splats(const PointPool& pool, std::uint32_t set, std::uint32_t begin, std::uint32_t end,
                 const BundleGrid& grid, float radius, SplatBlock& splats) {
    const GridAxes axes{grid.right,      grid.up,
                        grid.direction,  Vec3(BundleProjection(grid)(pool.middle())),
                        grid.spacing,    radius / grid.spacing,
                        float(grid.rows)};
    Columns columns;
    for (int k = 0; k < PointPool::columns; ++k)
        columns.of[k] = pool.column(set, PointPool::Column(k)) + begin;
    make_block(columns, pool.triangles(set) + begin, int(std::min<std::uint32_t>(end - begin, lanes)), axes,
               splats);
    splats.top = std::int32_t(grid.rows), splats.bottom = -1;
    for (int i = 0; i < lanes; ++i) {
        const bool none = splats.first_row[i] > splats.last_row[i];
        splats.top = std::min(splats.top, none ? splats.top : splats.first_row[i]);
        splats.bottom = std::max(splats.bottom, none ? -1 : splats.last_row[i]);
    }
}

}  // namespace mote::gathering
