// Discs on the grid of a bundle's rays.
//
// With (dx, dy) the offset of a ray from the disc's centre on the grid [rays], it meets the disc's plane, of
// normal n, at s (dx (right - alpha direction) + dy (up - beta direction)) from the centre, where alpha =
// n.right / n.direction, beta = n.up / n.direction and s is the spacing. On the grid the disc is an ellipse.
//
// Discs reach few rays each, no two of them equally many. What is done to one is therefore done to a block of
// them side by side, and what differs is counted instead of decided.
#pragma once

#include "gathering/ray_bundles/hit_band.h"
#include "gathering/ray_bundles/point_pool.h"

namespace mote::gathering {

/// Discs that follow each other in a set of points: every member has one entry a disc.
struct SplatBlock {
    static constexpr int lanes = int(PointPool::block);
    using Floats = float[lanes];
    /// Something that grows evenly by column and row.
    struct Plane {
        alignas(32) Floats at, by_x, by_y;  ///< at the centre
    };

    alignas(32) Floats x, y;  ///< centre [rays]
    alignas(32) Floats lean;  ///< how far the middle of a row's rays is from that of the row before [rays]
    alignas(32) Floats width,
        narrowing;   ///< a row has the rays within sqrt(width - narrowing dy^2) of its middle
    Plane distance;  ///< [m]
    Plane u, v;      ///< in units of 1 / 65535
    alignas(32) std::int32_t first_row[lanes], last_row[lanes];  ///< none where first_row > last_row
    alignas(32) std::uint32_t triangle[lanes];                   ///< with the bit of BundleHit
    std::int32_t top, bottom;                                    ///< rows that any disc reaches
};

/// Discs of `radius` [m] around points [begin, begin + lanes) of a set, of which those below `end` exist;
/// `begin` is a multiple of PointPool::block. A disc that is seen on edge has no rows.
void make_splats(const PointPool& pool, std::uint32_t set, std::uint32_t begin, std::uint32_t end,
                 const BundleGrid& grid, float radius, SplatBlock& splats);

/// Adds the hits of the discs on rows [begin, end) of the grid to the band that begins at row `begin`. Beside
/// the triangle u and v are those of its border.
void splat_rows(const SplatBlock& splats, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band);

}  // namespace mote::gathering
