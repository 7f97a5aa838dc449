#include "gathering/ray_bundles/bundle_assembly.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <atomic>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::size_t max_hits = 0xffffffffu;  // what RayBundle::first can count

std::size_t bytes_of(std::size_t rays, std::size_t hits) {
    return (rays + 1) * sizeof(std::uint32_t) + hits * sizeof(BundleHit);
}

/// A grid of the same bounds with a wider spacing.
struct Coarser {
    double spacing, columns, rows;
    Coarser(const BundleGrid& grid, double times)
        : spacing(times * double(grid.spacing)),
          columns(std::ceil((double(grid.columns) - 2.0) / times) + 2.0),
          rows(std::ceil((double(grid.rows) - 2.0) / times) + 2.0) {}
    double rays() const { return columns * rows; }
    double largest_inside() const { return (columns - 1.0) * (rows - 1.0); }
};

[[noreturn]] void refuse(const BundleGrid& grid, double all_hits, std::size_t budget) {
    const double inside = (double(grid.columns) - 2.0) * (double(grid.rows) - 2.0);
    const double allowed = std::min(double(budget), double(max_hits) * sizeof(BundleHit));
    double times = 1.0, coarse_bytes = infinity;
    while (coarse_bytes > 0.95 * allowed && times < 1e9) {
        times *= 1.05;
        const Coarser coarser(grid, times);
        coarse_bytes = (coarser.rays() + 1.0) * sizeof(std::uint32_t) +
                       all_hits * coarser.largest_inside() / std::max(inside, 1.0) * sizeof(BundleHit);
        if (coarser.rays() <= 9.0) break;  // no grid is coarser than that
    }
    const Coarser fits(grid, times);
    const double bytes = double(bytes_of(grid.rays(), 0)) + all_hits * sizeof(BundleHit);
    throw InputError(fmt::format(
        "a ray-bundle of {} x {} rays takes more than the memory allowed for it{}: it would be about{}; "
        "{} x {} rays fit, {:.3g} m apart",
        grid.columns, grid.rows, memory_text(allowed), memory_text(bytes), fits.columns, fits.rows,
        fits.spacing));
}

/// Bands one after the other; each leaves memory as soon as it has been copied.
RayBundle joined(const BundleGrid& grid, std::vector<OrderedBand>& bands, std::size_t hits) {
    RayBundle bundle{grid, {}, {}};
    with_memory_for("a ray-bundle" + memory_text(double(bytes_of(grid.rays(), hits))),
                    [&] { bundle.first.reserve(grid.rays() + 1), bundle.hits.reserve(hits); });
    bundle.first.push_back(0);
    for (OrderedBand& band : bands) {
        for (const std::uint32_t count : band.counts) bundle.first.push_back(bundle.first.back() + count);
        bundle.hits.insert(bundle.hits.end(), band.hits.begin(), band.hits.end());
        band = {};
    }
    return bundle;
}

}  // namespace

RayBundle assemble_bundle(const BundleGrid& grid, std::uint32_t rows_per_band, const HitOrder& order,
                          const BundleLimits& limits, BandScratch& scratch, const TraceRows& trace_rows) {
    if (bytes_of(grid.rays(), 0) > limits.memory_budget)
        refuse(grid, limits.largest_hits, limits.memory_budget);
    const std::uint32_t count = (grid.rows + rows_per_band - 1) / rows_per_band;
    std::vector<OrderedBand> bands(count);
    std::atomic<std::size_t> hits{0}, rays{0};
    tbb::parallel_for(std::uint32_t(0), count, [&](std::uint32_t i) {
        limits.cancelled.check();
        const std::uint32_t begin = i * rows_per_band, end = std::min(begin + rows_per_band, grid.rows);
        HitBand& band = scratch.local();
        band.clear();
        trace_rows(begin, end, band);
        bands[i] = band.ordered((end - begin) * grid.columns, order);
        const std::size_t rays_now = rays += std::size_t(end - begin) * grid.columns;
        const std::size_t hits_now = hits += bands[i].hits.size();
        if (hits_now > max_hits || bytes_of(grid.rays(), hits_now) > limits.memory_budget)
            refuse(grid, double(hits_now) * double(grid.rays()) / double(rays_now), limits.memory_budget);
    });
    return joined(grid, bands, hits);
}

}  // namespace mote::gathering
