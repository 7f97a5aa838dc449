#include "gathering/ray_bundles/scan_form.h"

#include "gathering/ray_bundles/grid_steps.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t rays_per_scan_band = 8192;  // some hundred kilobytes of hits
constexpr std::int64_t narrow = 4;  // columns that are tried rather than narrowed down row by row

/// Where row y runs through the triangle, with room for rounding: rays outside of it cannot hit. What lies
/// within is put to the rule.
GridSteps columns_of(const std::array<Vec3d, 3>& p, double y, std::uint32_t columns) {
    constexpr double room = 1e-6;
    double lower = infinity, upper = -infinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &a = p[i], &b = p[(i + 1) % 3];
        if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
        const double height = b.y - a.y, fraction = (y - a.y) / height;
        const double from = height != 0.0 ? a.x + fraction * (b.x - a.x) : a.x,
                     to = height != 0.0 ? from : b.x;
        lower = std::min(lower, std::min(from, to)), upper = std::max(upper, std::max(from, to));
    }
    return GridSteps(lower - room, upper + room, columns);
}

}  // namespace

ScanForm::ScanForm(const SurfaceTriangles& triangles, const TriangleCull& cull, const BundleGrid& grid,
                   std::size_t memory_budget, CancelToken cancelled)
    : triangles_(triangles),
      grid_(grid),
      projection_(grid),
      rows_per_band_(
          std::clamp(rays_per_scan_band / std::max(grid.columns, 1u), 1u, std::max(grid.rows, 1u))),
      bins_(cull, grid, rows_per_band_, memory_budget, cancelled) {}

void ScanForm::scan_rows(std::uint32_t begin, std::uint32_t end, HitBand& band) const {
    for (const std::uint32_t index : bins_.of_band(begin / rows_per_band_)) {
        const ProjectedTriangle triangle(project(projection_, triangles_.corners[index]));
        const auto& p = triangle.corners();
        const GridSteps rows(std::max(double(begin), lowest_of(p[0].y, p[1].y, p[2].y)),
                             highest_of(p[0].y, p[1].y, p[2].y), end);
        const GridSteps box(lowest_of(p[0].x, p[1].x, p[2].x), highest_of(p[0].x, p[1].x, p[2].x),
                            grid_.columns);
        for (std::int64_t y = rows.from; y <= rows.to; ++y) {
            const GridSteps columns =
                box.to - box.from < narrow ? box : columns_of(p, double(y), grid_.columns);
            const auto first = std::uint32_t(y - begin) * grid_.columns;
            for (std::int64_t x = columns.from; x <= columns.to; ++x)
                if (const auto hit = triangle.hit(double(x), double(y), index))
                    band.add(first + std::uint32_t(x), *hit);
        }
    }
}

}  // namespace mote::gathering
