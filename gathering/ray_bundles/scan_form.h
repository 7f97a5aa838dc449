// A bundle by a scan of the triangles: each is laid over the grid, row by row, and the rays between its edges
// hit it. What rasterizers do, with all fragments kept (the k-buffer of Bavoil & Myers 2008 without its k). A
// band of rows is scanned by one thread, whose hits stay in its cache.
#pragma once

#include "gathering/ray_bundles/band_bins.h"
#include "gathering/ray_bundles/hit_band.h"
#include "gathering/ray_bundles/projected_triangle.h"

namespace mote::gathering {

class ScanForm {
  public:
    /// Keeps references to the triangles and the grid. Throws Cancelled when it is cancelled.
    ScanForm(const SurfaceTriangles& triangles, const TriangleCull& cull, const BundleGrid& grid,
             std::size_t memory_budget, core::CancelToken cancelled);

    /// No: sorting the triangles would take more than the budget.
    bool possible() const { return bins_.complete(); }
    std::uint32_t rows_per_band() const { return rows_per_band_; }
    /// A whole band: rows [begin, end), where `begin` is a multiple of rows_per_band(). Safe from many
    /// threads.
    void scan_rows(std::uint32_t begin, std::uint32_t end, HitBand& band) const;

  private:
    const SurfaceTriangles& triangles_;
    const BundleGrid& grid_;
    BundleProjection projection_;
    std::uint32_t rows_per_band_;
    BandBins bins_;
};

}  // namespace mote::gathering
