#include "gathering/ray_bundles/splats.h"

#include <algorithm>
#include <cmath>

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/bundle_projection.h"
#include "gathering/ray_bundles/lanes.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr int lanes = SplatBlock::lanes;

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

/// One row of each disc: its first ray, how many rays, and the planes at the first.
struct RowLanes {
    alignas(32) float distance[lanes], u[lanes], v[lanes];
    alignas(32) std::int32_t first[lanes], count[lanes], row[lanes];

    /// The k-th row of each that lies in [begin, end), from which rows are counted.
    RowLanes(const SplatBlock& s, std::int32_t k, std::int32_t begin, std::int32_t end, float last_column) {
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < lanes; ++i) {
            const std::int32_t top = s.first_row[i] > begin ? s.first_row[i] : begin;
            const std::int32_t bottom = s.last_row[i] < end - 1 ? s.last_row[i] : end - 1;
            const float dy = float(top + k) - s.y[i], middle = s.x[i] + s.lean[i] * dy;
            const float half = std::sqrt(max_of(0.0f, s.width[i] - s.narrowing[i] * dy * dy));
            const float left = std::ceil(max_of(middle - half, 0.0f));
            const float right = std::floor(clamped(middle + half, -1.0f, last_column));
            const float many = top + k <= bottom ? max_of(right - left + 1.0f, 0.0f) : 0.0f,
                        dx = left - s.x[i];
            row[i] = top + k - begin;
            first[i] = std::int32_t(min_of(left, last_column)), count[i] = std::int32_t(many);
            distance[i] = s.distance.at[i] + s.distance.by_y[i] * dy + s.distance.by_x[i] * dx;
            u[i] = s.u.at[i] + s.u.by_y[i] * dy + s.u.by_x[i] * dx;
            v[i] = s.v.at[i] + s.v.by_y[i] * dy + s.v.by_x[i] * dx;
        }
    }
};

/// Which discs have rays in a row; returns how many.
int lanes_with_rays(const RowLanes& rows, int* with) {
    int found = 0;
    for (int i = 0; i < lanes; ++i) with[found] = i, found += rows.count[i] > 0 ? 1 : 0;
    return found;
}

/// Leaves out what a ray passes before its origin; returns how many are left.
int keep_in_front(FoundHit* hits, int count) {
    return int(
        std::remove_if(hits, hits + count, [](const FoundHit& f) { return !(f.hit.distance > 0.0f); }) -
        hits);
}

constexpr int step = 8;  ///< rays that are made at once, though there may be fewer

/// To [0, upper].
void clamp(Float8& x, const Float8& upper) {
    const Float8 zero{};
    x = x > zero ? x : zero;
    x = x < upper ? x : upper;
}

/// Every other entry from each.
void interleave(const Int8& even, const Int8& odd, Int8& first, Int8& second) {
    first = __builtin_shufflevector(even, odd, 0, 8, 1, 9, 2, 10, 3, 11);
    second = __builtin_shufflevector(even, odd, 4, 12, 5, 13, 6, 14, 7, 15);
}

void add_rays(const SplatBlock& s, const RowLanes& rows, int i, std::uint32_t columns, HitBand& band) {
    const Int8 to_right = {0, 1, 2, 3, 4, 5, 6, 7}, triangle = Int8{} + std::int32_t(s.triangle[i]);
    const std::int32_t first = rows.row[i] * std::int32_t(columns) + rows.first[i], all = rows.count[i];
    for (int done = 0; done < all; done += step) {
        const Int8 ray = to_right + (first + done);
        const Float8 dx = __builtin_convertvector(to_right + done, Float8), most = Float8{} + 65535.0f;
        const Float8 distance = rows.distance[i] + dx * s.distance.by_x[i];
        Float8 u = rows.u[i] + dx * s.u.by_x[i], v = rows.v[i] + dx * s.v.by_x[i];
        clamp(u, most), clamp(v, most - u);
        const Int8 uv = __builtin_convertvector(u, Int8) | __builtin_convertvector(v, Int8) << 16;
        // From four numbers of each hit to one hit after the other.
        Int8 distance_bits, ray_triangle[2], distance_uv[2], hits[4];
        load(&distance, distance_bits);
        interleave(ray, triangle, ray_triangle[0], ray_triangle[1]);
        interleave(distance_bits, uv, distance_uv[0], distance_uv[1]);
        for (int k = 0; k < 2; ++k) interleave(ray_triangle[k], distance_uv[k], hits[2 * k], hits[2 * k + 1]);
        FoundHit* to = band.room(step);
        store(hits, to);
        const int count = std::min(all - done, step);
        const float ends = min_of(distance[0], distance[count - 1]);
        band.added(ends > 0.0f ? count : keep_in_front(to, count));
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

void splat_rows(const SplatBlock& s, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band) {
    const float last_column = float(grid.columns) - 1.0f;
    const auto from = std::int32_t(begin), to = std::int32_t(end);
    std::int32_t most = 0;  // rows of a disc
    for (int i = 0; i < lanes; ++i)
        most = std::max(most, std::min(s.last_row[i], to - 1) - std::max(s.first_row[i], from) + 1);
    int with[lanes];
    for (std::int32_t k = 0; k < most; ++k) {
        const RowLanes rows(s, k, from, to, last_column);
        const int found = lanes_with_rays(rows, with);
        for (int j = 0; j < found; ++j) add_rays(s, rows, with[j], grid.columns, band);
    }
}

}  // namespace mote::gathering
