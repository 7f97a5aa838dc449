// Triangles by the bands of rows in which they can have hits.
#pragma once

#include <span>

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/triangle_cull.h"

namespace mote::gathering {

class BandBins {
  public:
    /// In parallel; triangles that fall between all rays are in no bin. Throws InputError where the bins
    /// would take more than the budget, Cancelled when it is cancelled.
    BandBins(const TriangleCull& cull, const BundleGrid& grid, std::uint32_t rows_per_band,
             std::size_t memory_budget, core::CancelToken cancelled);

    /// No: they would take more than the budget, and are empty.
    bool complete() const { return complete_; }
    /// In no particular order.
    std::span<const std::uint32_t> of_band(std::size_t band) const {
        return {binned_.data() + first_[band], first_[band + 1] - first_[band]};
    }
    std::size_t memory_bytes() const {
        return binned_.size() * sizeof(std::uint32_t) + first_.size() * sizeof(std::size_t);
    }

  private:
    bool complete_ = true;
    std::vector<std::size_t> first_;  ///< by band, and one more
    std::vector<std::uint32_t> binned_;
};

}  // namespace mote::gathering
