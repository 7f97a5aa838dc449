#include "gathering/ray_bundles/band_bins.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t triangles_per_task = 64 * TriangleCull::block;

/// A triangle with the bands that it reaches.
struct Reaching {
    std::uint32_t triangle, begin, end;
};

/// Bands that triangles [begin, end) reach, in order of the triangles.
std::vector<Reaching> bands_of(const TriangleCull& cull, const BundleGrid& grid, std::uint32_t rows_per_band,
                               std::size_t begin, std::size_t end) {
    std::vector<Reaching> found;
    TriangleCull::Rows rows;
    for (; begin < end; begin += TriangleCull::block) {
        const std::size_t count = std::min(TriangleCull::block, end - begin);
        cull.find(grid, begin, count, rows);
        for (std::size_t i = 0; i < count; ++i)
            if (rows.first[i] <= rows.last[i])
                found.push_back({std::uint32_t(begin + i), std::uint32_t(rows.first[i]) / rows_per_band,
                                 std::uint32_t(rows.last[i]) / rows_per_band + 1});
    }
    return found;
}

}  // namespace

BandBins::BandBins(const TriangleCull& cull, const BundleGrid& grid, std::uint32_t rows_per_band,
                   std::size_t memory_budget, CancelToken cancelled) {
    const std::size_t count = cull.size();
    const std::size_t bands = (grid.rows + rows_per_band - 1) / rows_per_band;
    const std::size_t tasks = (count + triangles_per_task - 1) / triangles_per_task;
    std::vector<std::vector<Reaching>> found(tasks);
    // Counted first, then put where the counts say.
    std::vector<std::atomic<std::size_t>> next(bands + 1);
    tbb::parallel_for(std::size_t(0), tasks, [&](std::size_t task) {
        cancelled.check();
        const std::size_t begin = task * triangles_per_task;
        found[task] = bands_of(cull, grid, rows_per_band, begin, std::min(begin + triangles_per_task, count));
        for (const Reaching& t : found[task])
            for (std::uint32_t b = t.begin; b < t.end; ++b)
                next[b + 1].fetch_add(1, std::memory_order_relaxed);
    });
    first_.assign(bands + 1, 0);
    for (std::size_t b = 0; b < bands; ++b) first_[b + 1] = first_[b] + next[b + 1], next[b] = first_[b];
    complete_ = first_.back() * sizeof(std::uint32_t) <= memory_budget;
    if (!complete_) return;
    binned_.resize(first_.back());
    tbb::parallel_for(std::size_t(0), tasks, [&](std::size_t task) {
        for (const Reaching& t : found[task])
            for (std::uint32_t b = t.begin; b < t.end; ++b)
                binned_[next[b].fetch_add(1, std::memory_order_relaxed)] = t.triangle;
    });
}

}  // namespace mote::gathering
