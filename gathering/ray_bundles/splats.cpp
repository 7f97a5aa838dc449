#include "gathering/ray_bundles/splats.h"

#include <algorithm>
#include <cmath>

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/bundle_projection.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t lanes = 64;  // points that are made splats together

/// A vector a lane, by coordinate.
struct Vectors {
    alignas(32) float x[lanes], y[lanes], z[lanes];
    void set(std::size_t lane, const Vec3& v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
    Vec3 at(std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
};

/// What the grid asks of a vector: its components along the grid's axes, here with spacing 1.
struct Axes {
    Vec3 right, up, along;
    float spacing, radius, rows;
};

struct Block {
    Vectors center, e1, e2;  // from the middle of the grid's front
    alignas(32) float u[lanes], v[lanes];
};

float clamped(float x, float lower, float upper) { return min_of(max_of(x, lower), upper); }

/// All splats of a block, in single precision; the compiler takes eight at a time.
void make_block(const Block& block, const Axes& axes, const Vec3& shift, Splat* splats, std::size_t count) {
    alignas(32) float out[18][lanes];
    MOTE_INDEPENDENT_LANES
    for (std::size_t i = 0; i < lanes; ++i) {
        const Vec3 e1 = block.e1.at(i), e2 = block.e2.at(i), cross = glm::cross(e1, e2);
        const float inverse = 1.0f / glm::dot(cross, cross), scale = std::sqrt(inverse);
        const float right = glm::dot(cross, axes.right) * scale, up = glm::dot(cross, axes.up) * scale;
        const float along = glm::dot(cross, axes.along) * scale, toward = 1.0f / along;
        const float alpha = right * toward, beta = up * toward, s = axes.spacing;
        const Vec3 center = block.center.at(i);
        const float y = glm::dot(center, axes.up) / s + shift.y;
        const float a = 1.0f + alpha * alpha, b = alpha * beta, c = 1.0f + beta * beta;
        const float reach = axes.radius / s, inverse_a = 1.0f / a;
        out[0][i] = glm::dot(center, axes.right) / s + shift.x;
        out[1][i] = y;
        out[2][i] = -b * inverse_a;
        out[3][i] = reach * reach * inverse_a;
        out[4][i] = (a * c - b * b) * inverse_a * inverse_a;
        out[5][i] = glm::dot(center, axes.along) + shift.z;
        out[6][i] = -s * alpha, out[7][i] = -s * beta;
        const Vec3 by_x = s * (axes.right - alpha * axes.along), by_y = s * (axes.up - beta * axes.along);
        const Vec3 grow_u = glm::cross(e2, cross) * (65535.0f * inverse);
        const Vec3 grow_v = glm::cross(cross, e1) * (65535.0f * inverse);
        out[8][i] = 65535.0f * block.u[i], out[9][i] = glm::dot(grow_u, by_x),
        out[10][i] = glm::dot(grow_u, by_y);
        out[11][i] = 65535.0f * block.v[i], out[12][i] = glm::dot(grow_v, by_x),
        out[13][i] = glm::dot(grow_v, by_y);
        const float height = reach * std::sqrt(max_of(0.0f, 1.0f - up * up));
        const bool seen = std::fabs(along) > 1e-5f;
        out[14][i] = std::ceil(clamped(y - height, 0.0f, axes.rows));
        out[15][i] = seen ? std::floor(clamped(y + height, -1.0f, axes.rows - 1.0f)) : -1.0f;
        out[16][i] = along;
    }
    for (std::size_t i = 0; i < count; ++i) {
        Splat& s = splats[i];
        s.x = out[0][i], s.y = out[1][i], s.lean = out[2][i], s.width = out[3][i], s.narrowing = out[4][i];
        s.distance = {out[5][i], out[6][i], out[7][i]};
        s.u = {out[8][i], out[9][i], out[10][i]}, s.v = {out[11][i], out[12][i], out[13][i]};
        s.first_row = std::int32_t(out[14][i]), s.last_row = std::int32_t(out[15][i]);
        if (out[16][i] > 0.0f) s.triangle |= BundleHit::behind_bit;
    }
}

}  // namespace

void make_splats(const SurfaceTriangles& triangles, const BundleGrid& grid,
                 std::span<const SurfacePoint> points, float radius, std::span<Splat> splats) {
    // Single precision counts from the middle of the surfaces, the grid's front from there in double.
    const Vec3 middle = triangles.bounds.center(), shift(BundleProjection(grid)(middle));
    const Axes axes{grid.right, grid.up, grid.direction, grid.spacing, radius, float(grid.rows)};
    Block block{};
    for (std::size_t begin = 0; begin < points.size(); begin += lanes) {
        const std::size_t count = std::min(lanes, points.size() - begin);
        for (std::size_t i = 0; i < count; ++i) {
            const SurfacePoint& p = points[begin + i];
            const auto& c = triangles.corners[p.triangle];
            const Vec3 e1 = c[1] - c[0], e2 = c[2] - c[0];
            block.e1.set(i, e1), block.e2.set(i, e2);
            block.center.set(i, (c[0] - middle) + (p.u * e1 + p.v * e2));
            block.u[i] = p.u, block.v[i] = p.v, splats[begin + i].triangle = p.triangle;
        }
        make_block(block, axes, shift, splats.data() + begin, count);
    }
}

void splat_rows(const Splat& s, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band) {
    const float last_column = float(grid.columns) - 1.0f;
    const std::int32_t last_row = std::min(s.last_row, std::int32_t(end) - 1);
    for (std::int32_t row = std::max(s.first_row, std::int32_t(begin)); row <= last_row; ++row) {
        const float dy = float(row) - s.y, middle = s.x + s.lean * dy;
        const float half = std::sqrt(max_of(0.0f, s.width - s.narrowing * dy * dy));
        const auto first = std::int32_t(std::ceil(max_of(middle - half, 0.0f)));
        const auto last = std::int32_t(std::floor(min_of(middle + half, last_column)));
        // At column 0 of this row.
        const auto start = [&](const SplatPlane& p) { return p.at + p.by_y * dy - p.by_x * s.x; };
        const float distance0 = start(s.distance), u0 = start(s.u), v0 = start(s.v);
        const std::uint32_t ray = (std::uint32_t(row) - begin) * grid.columns;
        for (std::int32_t column = first; column <= last; ++column) {
            const float x = float(column), distance = distance0 + x * s.distance.by_x;
            if (!(distance > 0.0f)) continue;
            const float u = clamped(u0 + x * s.u.by_x, 0.0f, 65535.0f);
            const float v = clamped(v0 + x * s.v.by_x, 0.0f, 65535.0f - u);
            band.add(ray + std::uint32_t(column),
                     {distance, s.triangle, std::uint16_t(std::int32_t(u)), std::uint16_t(std::int32_t(v))});
        }
    }
}

}  // namespace mote::gathering
