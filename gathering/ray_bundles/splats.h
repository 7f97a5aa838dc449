// Discs on the grid of a bundle's rays.
//
// With (dx, dy) the offset of a ray from the disc's centre on the grid [rays], it meets the disc's plane, of
// normal n, at s (dx (right - alpha direction) + dy (up - beta direction)) from the centre, where alpha =
// n.right / n.direction, beta = n.up / n.direction and s is the spacing. On the grid the disc is an ellipse.
#pragma once

#include <span>
#include <vector>

#include "gathering/ray_bundles/hit_band.h"
#include "gathering/ray_bundles/point_pool.h"

namespace mote::gathering {

/// Something that grows evenly by column and row.
struct SplatPlane {
    float at, by_x, by_y;  ///< at the centre
};

struct Splat {
    float x, y;              ///< centre [rays]
    float lean;              ///< by how much the middle of the rays of a row moves to the next row [rays]
    float width, narrowing;  ///< a row has the rays within sqrt(width - narrowing dy^2) of its middle
    SplatPlane distance;     ///< [m]
    SplatPlane u, v;         ///< in units of 1 / 65535
    std::int32_t first_row, last_row;  ///< none where first_row > last_row
    std::uint32_t triangle;            ///< with the bit of BundleHit
};

/// Discs of `radius` [m] around points [begin, begin + splats.size()) of a set; `begin` is a multiple of
/// PointPool::block. A disc that is seen on edge has no rows.
void make_splats(const PointPool& pool, std::uint32_t set, std::uint32_t begin, const BundleGrid& grid,
                 float radius, std::span<Splat> splats);

/// Adds the splat's hits on rows [begin, end) of the grid to the band that begins at row `begin`. Beside the
/// triangle u and v are those of its border.
void splat_rows(const Splat& splat, const BundleGrid& grid, std::uint32_t begin, std::uint32_t end,
                HitBand& band);

}  // namespace mote::gathering
