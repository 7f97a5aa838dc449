// From bands of rays, found in parallel, to a bundle within its budget.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <functional>

#include "core/objects/cancellation.h"
#include "gathering/ray_bundles/hit_band.h"

namespace mote::gathering {

struct BundleLimits {
    std::size_t memory_budget;  ///< [B]
    double largest_hits;        ///< more than this there are hardly, see refusals
    core::CancelToken cancelled;
};

/// Adds the hits of rows [begin, end) to a band whose first ray is that of row `begin`. Called from many
/// threads.
using TraceRows = std::function<void(std::uint32_t begin, std::uint32_t end, HitBand& band)>;

/// Buffers that threads reuse from bundle to bundle.
using BandScratch = tbb::enumerable_thread_specific<HitBand>;

/// Traces bands of `rows_per_band` rows in parallel; the same bits for any number of threads. At no time do
/// the hits take more than the budget: throws InputError, which names the rays and the spacing that fit, as
/// soon as they would. Throws Cancelled.
RayBundle assemble_bundle(const BundleGrid& grid, std::uint32_t rows_per_band, const HitOrder& order,
                          const BundleLimits& limits, BandScratch& scratch, const TraceRows& trace_rows);

}  // namespace mote::gathering
