#include "gathering/ray_bundles/splats.h"

#include <algorithm>
#include <cmath>

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/bundle_projection.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr int lanes = int(PointPool::block);

/// What the grid is to single precision, which counts from the middle of the surfaces.
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

/// Splats by value, a block of each.
struct SplatBlock {
    alignas(32) float x[lanes], y[lanes], lean[lanes], width[lanes], narrowing[lanes];
    alignas(32) float distance[3][lanes], u[3][lanes], v[3][lanes], first_row[lanes], last_row[lanes],
        along[lanes];
};

void make_block(const Columns& c, const GridAxes& g, SplatBlock& out) {
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < lanes; ++i) {
        const Vec3 center = c.vector(PointPool::center_x, i), n = c.vector(PointPool::normal_x, i);
        const float right = glm::dot(n, g.right), up = glm::dot(n, g.up), along = glm::dot(n, g.along);
        const float alpha = right / along, beta = up / along, s = g.spacing;
        const float y = glm::dot(center, g.up) / s + g.shift.y;
        // a dx^2 + 2 b dx dy + c dy^2 <= reach^2, where b = alpha beta, c = 1 + beta^2.
        const float a = 1.0f + alpha * alpha, inverse_a = 1.0f / a;
        out.x[i] = glm::dot(center, g.right) / s + g.shift.x, out.y[i] = y;
        out.lean[i] = -alpha * beta * inverse_a;
        out.width[i] = g.reach * g.reach * inverse_a;
        out.narrowing[i] = (a + beta * beta) * inverse_a * inverse_a;
        out.distance[0][i] = glm::dot(center, g.along) + g.shift.z;
        out.distance[1][i] = -s * alpha, out.distance[2][i] = -s * beta;
        const Vec3 by_x = s * (g.right - alpha * g.along), by_y = s * (g.up - beta * g.along);
        const Vec3 grow_u = c.vector(PointPool::grow_u_x, i), grow_v = c.vector(PointPool::grow_v_x, i);
        out.u[0][i] = c.of[PointPool::u][i], out.u[1][i] = glm::dot(grow_u, by_x),
        out.u[2][i] = glm::dot(grow_u, by_y);
        out.v[0][i] = c.of[PointPool::v][i], out.v[1][i] = glm::dot(grow_v, by_x),
        out.v[2][i] = glm::dot(grow_v, by_y);
        const float height = g.reach * std::sqrt(max_of(0.0f, 1.0f - up * up));
        out.first_row[i] = std::ceil(clamped(y - height, 0.0f, g.rows));
        const float last = std::floor(clamped(y + height, -1.0f, g.rows - 1.0f));
        out.last_row[i] = along * along > 1e-10f ? last : -1.0f;
        out.along[i] = along;
    }
}

Splat splat_of(const SplatBlock& b, int i, std::uint32_t triangle) {
    return {b.x[i],
            b.y[i],
            b.lean[i],
            b.width[i],
            b.narrowing[i],
            {b.distance[0][i], b.distance[1][i], b.distance[2][i]},
            {b.u[0][i], b.u[1][i], b.u[2][i]},
            {b.v[0][i], b.v[1][i], b.v[2][i]},
            std::int32_t(b.first_row[i]),
            std::int32_t(b.last_row[i]),
            b.along[i] > 0.0f ? triangle | BundleHit::behind_bit : triangle};
}

/// The rays of a splat's rows, and its planes at column 0 of them: eight rows at a time.
struct RowBlock {
    static constexpr int rows = 8;
    alignas(32) float distance[rows], u[rows], v[rows];
    alignas(32) std::int32_t first[rows], last[rows];

    RowBlock(const Splat& s, std::int32_t row, float last_column) {
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < rows; ++i) {
            const float dy = float(row + i) - s.y, middle = s.x + s.lean * dy;
            const float half = std::sqrt(max_of(0.0f, s.width - s.narrowing * dy * dy));
            first[i] = std::int32_t(std::ceil(max_of(middle - half, 0.0f)));
            last[i] = std::int32_t(std::floor(min_of(middle + half, last_column)));
            distance[i] = s.distance.at + s.distance.by_y * dy - s.distance.by_x * s.x;
            u[i] = s.u.at + s.u.by_y * dy - s.u.by_x * s.x;
            v[i] = s.v.at + s.v.by_y * dy - s.v.by_x * s.x;
        }
    }
};

}  // namespace

void make_splats(const PointPool& pool, std::uint32_t set, std::uint32_t begin, const BundleGrid& grid,
                 float radius, std::span<Splat> splats) {
    const GridAxes axes{grid.right,      grid.up,
                        grid.direction,  Vec3(BundleProjection(grid)(pool.middle())),
                        grid.spacing,    radius / grid.spacing,
                        float(grid.rows)};
    SplatBlock block;
    for (std::size_t first = 0; first < splats.size(); first += lanes) {
        Columns columns;
        for (int k = 0; k < PointPool::columns; ++k)
            columns.of[k] = pool.column(set, PointPool::Column(k)) + begin + first;
        make_block(columns, axes, block);
        const std::uint32_t* triangles = pool.triangles(set) + begin + first;
        const auto count = int(std::min(std::size_t(lanes), splats.size() - first));
        for (int i = 0; i < count; ++i) splats[first + std::size_t(i)] = splat_of(block, i, triangles[i]);
    }
}

void splat_rows(const Splat& s, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band) {
    const float last_column = float(grid.columns) - 1.0f;
    const std::int32_t last_row = std::min(s.last_row, std::int32_t(end) - 1);
    for (std::int32_t top = std::max(s.first_row, std::int32_t(begin)); top <= last_row;
         top += RowBlock::rows) {
        const RowBlock rows(s, top, last_column);
        const int count = std::min(RowBlock::rows, last_row - top + 1);
        for (int i = 0; i < count; ++i) {
            const std::uint32_t ray = (std::uint32_t(top + i) - begin) * grid.columns;
            for (std::int32_t column = rows.first[i]; column <= rows.last[i]; ++column) {
                const float x = float(column), distance = rows.distance[i] + x * s.distance.by_x;
                if (!(distance > 0.0f)) continue;
                const float u = clamped(rows.u[i] + x * s.u.by_x, 0.0f, 65535.0f);
                const float v = clamped(rows.v[i] + x * s.v.by_x, 0.0f, 65535.0f - u);
                band.add(ray + std::uint32_t(column), {distance, s.triangle, std::uint16_t(std::int32_t(u)),
                                                       std::uint16_t(std::int32_t(v))});
            }
        }
    }
}

}  // namespace mote::gathering
