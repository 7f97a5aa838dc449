// A bundle by a scan of the triangles: each is laid over the grid, row by row, and the rays between its edges
// hit it. What rasterizers do, with all fragments kept (the k-buffer of Bavoil & Myers 2008 without its k).
//
// Triangles are first put into bins, one for each band of rows; those that fall between all rays are left out
// there. A band is then scanned by one thread, whose hits stay in its cache.
#pragma once

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/hit_band.h"
#include "gathering/ray_bundles/projected_triangle.h"
#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

class ScanForm {
  public:
    /// Fills the bins of one grid, in parallel. Keeps references to both. Throws InputError where the bins
    /// would take more than the budget, Cancelled when asked to stop.
    ScanForm(const SurfaceTriangles& triangles, const BundleGrid& grid, std::size_t memory_budget,
             core::CancelToken cancelled);

    std::uint32_t rows_per_band() const { return rows_per_band_; }
    /// A whole band: rows [begin, end), where `begin` is a multiple of rows_per_band(). Safe from many
    /// threads.
    void scan_rows(std::uint32_t begin, std::uint32_t end, HitBand& band) const;
    std::size_t memory_bytes() const { return (binned_.size() + first_.size()) * sizeof(std::uint32_t); }

  private:
    const SurfaceTriangles& triangles_;
    const BundleGrid& grid_;
    BundleProjection projection_;
    std::uint32_t rows_per_band_;
    std::vector<std::size_t> first_;     ///< by band, and one more: its triangles are binned_[first_[b], ...)
    std::vector<std::uint32_t> binned_;  ///< in no particular order
};

}  // namespace mote::gathering
