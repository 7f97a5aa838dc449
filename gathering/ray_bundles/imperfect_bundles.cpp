#include "gathering/ray_bundles/imperfect_bundles.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/objects/error.h"
#include "gathering/ray_bundles/splats.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t rays_per_splat_band = 4096, blocks_per_task = 32;
constexpr std::uint32_t largest_count = 1u << 24;

/// Blocks of splats by the bands of rows that they reach.
class BlockBins {
  public:
    BlockBins(std::span<const SplatBlock> blocks, std::uint32_t bands, std::uint32_t rows_per_band)
        : first_(bands + 1, 0) {
        const auto for_each_band = [&](const SplatBlock& block, const auto& visit) {
            if (block.top > block.bottom) return;
            const std::uint32_t last = std::uint32_t(block.bottom) / rows_per_band;
            for (std::uint32_t b = std::uint32_t(block.top) / rows_per_band; b <= last; ++b) visit(b);
        };
        for (const SplatBlock& block : blocks)
            for_each_band(block, [&](std::uint32_t b) { ++first_[b + 1]; });
        for (std::uint32_t b = 0; b < bands; ++b) first_[b + 1] += first_[b];
        binned_.resize(first_.back());
        std::vector<std::size_t> next = first_;
        for (std::uint32_t i = 0; i < blocks.size(); ++i)
            for_each_band(blocks[i], [&](std::uint32_t b) { binned_[next[b]++] = i; });
    }
    std::span<const std::uint32_t> of_band(std::uint32_t band) const {
        return {binned_.data() + first_[band], first_[band + 1] - first_[band]};
    }

  private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> binned_;
};

std::uint32_t checked(std::uint32_t count, const char* what) {
    if (count == 0 || count > largest_count)
        throw InputError(
            fmt::format("imperfect ray-bundles need 1 to {} {}, not {}", largest_count, what, count));
    return count;
}

}  // namespace

ImperfectBundles::ImperfectBundles(const SurfaceTriangles& triangles, std::uint32_t points,
                                   std::uint32_t sets)
    : bounds_(triangles.bounds),
      pool_(triangles, checked(points, "points"), checked(sets, "sets of points")) {}

double ImperfectBundles::disc_radius(const ImperfectSettings& settings) const {
    const double patch = pool_.area() / std::max(1.0, double(pool_.points()));
    return double(settings.splat_size) * std::sqrt(patch / double(pi));
}

RayBundle ImperfectBundles::trace(const BundleGrid& grid, std::uint64_t set,
                                  const ImperfectSettings& settings) const {
    if (!(settings.splat_size > 0.0f) || !std::isfinite(settings.splat_size))
        throw InputError("the splat size of imperfect ray-bundles must be positive");
    settings.cancelled.check();
    const auto radius = float(disc_radius(settings));
    const std::uint32_t points = pool_.points(), count = (points + PointPool::block - 1) / PointPool::block;
    const auto blocks = std::make_unique_for_overwrite<SplatBlock[]>(count);
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, count, blocks_per_task), [&](const auto& range) {
        for (std::uint32_t i = range.begin(); i < range.end(); ++i)
            make_splats(pool_, std::uint32_t(set % pool_.sets()), i * PointPool::block, points, grid, radius,
                        blocks[i]);
    });
    const std::uint32_t rows =
        std::clamp(rays_per_splat_band / std::max(grid.columns, 1u), 1u, std::max(grid.rows, 1u));
    const BlockBins bins({blocks.get(), count}, (grid.rows + rows - 1) / rows, rows);
    const double largest_hits =
        pool_.area() * double(sqr(settings.splat_size)) / (double(grid.spacing) * double(grid.spacing));
    const HitOrder order{coincidence(grid, bounds_), settings.merge * radius};
    return assemble_bundle(grid, rows, order, {settings.memory_budget, largest_hits, settings.cancelled},
                           scratch_, [&](std::uint32_t begin, std::uint32_t end, HitBand& band) {
                               for (const std::uint32_t i : bins.of_band(begin / rows))
                                   splat_rows(blocks[i], grid, begin, end, band);
                           });
}

}  // namespace mote::gathering
