#include "gathering/ray_bundles/imperfect_bundles.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "core/objects/error.h"
#include "gathering/ray_bundles/bundle_assembly.h"
#include "gathering/ray_bundles/splats.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t rays_per_splat_band = 4096, points_per_task = 32 * PointPool::block;
constexpr std::uint32_t largest_count = 1u << 24;

/// Splats by the bands of rows that they reach.
class SplatBins {
  public:
    SplatBins(std::span<const Splat> splats, std::uint32_t bands, std::uint32_t rows_per_band)
        : first_(bands + 1, 0) {
        const auto for_each_band = [&](const Splat& splat, const auto& visit) {
            if (splat.first_row > splat.last_row) return;
            const std::uint32_t last = std::uint32_t(splat.last_row) / rows_per_band;
            for (std::uint32_t b = std::uint32_t(splat.first_row) / rows_per_band; b <= last; ++b) visit(b);
        };
        for (const Splat& splat : splats) for_each_band(splat, [&](std::uint32_t b) { ++first_[b + 1]; });
        for (std::uint32_t b = 0; b < bands; ++b) first_[b + 1] += first_[b];
        binned_.resize(first_.back());
        std::vector<std::size_t> next = first_;
        for (std::uint32_t i = 0; i < splats.size(); ++i)
            for_each_band(splats[i], [&](std::uint32_t b) { binned_[next[b]++] = i; });
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

std::vector<Splat> ImperfectBundles::splats(const BundleGrid& grid, std::uint64_t set, float radius) const {
    std::vector<Splat> splats(pool_.points());
    tbb::parallel_for(std::size_t(0), (splats.size() + points_per_task - 1) / points_per_task,
                      [&](std::size_t task) {
                          const std::size_t begin = task * points_per_task,
                                            end = std::min(begin + points_per_task, splats.size());
                          make_splats(pool_, std::uint32_t(set % pool_.sets()), std::uint32_t(begin), grid,
                                      radius, std::span(splats).subspan(begin, end - begin));
                      });
    return splats;
}

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
    const std::vector<Splat> splats = this->splats(grid, set, radius);
    const std::uint32_t rows =
        std::clamp(rays_per_splat_band / std::max(grid.columns, 1u), 1u, std::max(grid.rows, 1u));
    const SplatBins bins(splats, (grid.rows + rows - 1) / rows, rows);
    const double largest_hits =
        pool_.area() * double(sqr(settings.splat_size)) / (double(grid.spacing) * double(grid.spacing));
    const HitOrder order{coincidence(grid, bounds_), settings.merge * radius};
    return assemble_bundle(grid, rows, order, {settings.memory_budget, largest_hits, settings.cancelled},
                           scratch_, [&](std::uint32_t begin, std::uint32_t end, HitBand& band) {
                               for (const std::uint32_t i : bins.of_band(begin / rows))
                                   splat_rows(splats[i], grid, begin, end, band);
                           });
}

}  // namespace mote::gathering
