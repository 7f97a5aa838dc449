// The rays that discs reach, row by row.
#include <algorithm>
#include <cmath>

#include "core/math/vectorize.h"
#include "gathering/ray_bundles/lanes.h"
#include "gathering/ray_bundles/splats.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr int discs = SplatBlock::lanes;

/// One row of each disc: its first ray, how many rays, and the planes at the first.
struct RowLanes {
    alignas(32) float distance[discs], u[discs], v[discs];
    alignas(32) std::int32_t first[discs], count[discs], row[discs];

    /// The k-th row of each that lies in [begin, end), from which rows are counted.
    RowLanes(const SplatBlock& s, std::int32_t k, std::int32_t begin, std::int32_t end, float last_column) {
        MOTE_INDEPENDENT_LANES
        for (int i = 0; i < discs; ++i) {
            const std::int32_t top = s.first_row[i] > begin ? s.first_row[i] : begin;
            const std::int32_t bottom = s.last_row[i] < end - 1 ? s.last_row[i] : end - 1;
            const float dy = float(top + k) - s.y[i], middle = s.x[i] + s.lean[i] * dy;
            const float half = std::sqrt(max_of(0.0f, s.width[i] - s.narrowing[i] * dy * dy));
            const float left = std::ceil(max_of(middle - half, 0.0f));
            const float right = std::floor(min_of(max_of(middle + half, -1.0f), last_column));
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

/// Finds the discs that have rays in a row; returns their number.
int discs_with_rays(const RowLanes& rows, int* with) {
    int found = 0;
    for (int i = 0; i < discs; ++i) with[found] = i, found += rows.count[i] > 0 ? 1 : 0;
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

void splat_rows(const SplatBlock& s, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band) {
    const float last_column = float(grid.columns) - 1.0f;
    const auto from = std::int32_t(begin), to = std::int32_t(end);
    std::int32_t most = 0;  // rows of a disc
    for (int i = 0; i < discs; ++i)
        most = std::max(most, std::min(s.last_row[i], to - 1) - std::max(s.first_row[i], from) + 1);
    int with[discs];
    for (std::int32_t k = 0; k < most; ++k) {
        const RowLanes rows(s, k, from, to, last_column);
        const int found = discs_with_rays(rows, with);
        for (int j = 0; j < found; ++j) add_rays(s, rows, with[j], grid.columns, band);
    }
}

}  // namespace mote::gathering
