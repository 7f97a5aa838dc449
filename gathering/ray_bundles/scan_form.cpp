#include "gathering/ray_bundles/scan_form.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "core/objects/error.h"
#include "core/objects/memory_error.h"

namespace mote::gathering {

using namespace core;

namespace {

constexpr std::uint32_t rays_per_band = 8192;  // some hundred kilobytes of hits
constexpr std::size_t triangles_per_task = 4096;

/// Whole numbers from..to within [lower, upper] and [0, count); empty where from > to.
struct Steps {
    std::int64_t from, to;
    Steps(double lower, double upper, std::uint32_t count)
        : from(std::int64_t(std::ceil(std::clamp(lower, 0.0, double(count))))),
          to(std::int64_t(std::floor(std::clamp(upper, -1.0, double(count) - 1.0)))) {}
    bool empty() const { return from > to; }
};

/// Of numbers, without NaN.
double least(double a, double b, double c) { return std::min(a, std::min(b, c)); }
double most(double a, double b, double c) { return std::max(a, std::max(b, c)); }

/// The bands in which a triangle can have hits; empty where it falls between all rays.
class BandsOf {
  public:
    BandsOf(const BundleGrid& grid, std::uint32_t rows_per_band)
        : projection_(grid), grid_(grid), rows_per_band_(rows_per_band) {}
    struct Range {
        std::uint32_t begin, end;
    };
    Range operator()(const std::array<Vec3, 3>& corners) const {
        const Vec3d a = projection_(corners[0]), b = projection_(corners[1]), c = projection_(corners[2]);
        const Steps rows(least(a.y, b.y, c.y), most(a.y, b.y, c.y), grid_.rows);
        const Steps columns(least(a.x, b.x, c.x), most(a.x, b.x, c.x), grid_.columns);
        if (rows.empty() || columns.empty()) return {0, 0};
        return {std::uint32_t(rows.from) / rows_per_band_, std::uint32_t(rows.to) / rows_per_band_ + 1};
    }

  private:
    BundleProjection projection_;
    const BundleGrid& grid_;
    std::uint32_t rows_per_band_;
};

/// Where row y runs through the triangle, with room for rounding: rays outside of it cannot hit. What lies
/// within is put to the rule.
Steps columns_of(const std::array<Vec3d, 3>& p, double y, std::uint32_t columns) {
    constexpr double room = 1e-6;
    double lower = infinity, upper = -infinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3d &a = p[i], &b = p[(i + 1) % 3];
        if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
        const double height = b.y - a.y;
        const double at = height != 0.0 ? a.x + (y - a.y) / height * (b.x - a.x) : a.x;
        lower = std::min(lower, height != 0.0 ? at : std::min(a.x, b.x));
        upper = std::max(upper, height != 0.0 ? at : std::max(a.x, b.x));
    }
    return Steps(lower - room, upper + room, columns);
}

}  // namespace

ScanForm::ScanForm(const SurfaceTriangles& triangles, const BundleGrid& grid, std::size_t memory_budget,
                   CancelToken cancelled)
    : triangles_(triangles),
      grid_(grid),
      projection_(grid),
      rows_per_band_(std::clamp(rays_per_band / std::max(grid.columns, 1u), 1u, std::max(grid.rows, 1u))) {
    const std::size_t bands = (grid.rows + rows_per_band_ - 1) / rows_per_band_;
    const BandsOf bands_of(grid, rows_per_band_);
    const std::size_t tasks = (triangles.size() + triangles_per_task - 1) / triangles_per_task;
    const auto for_each_triangle = [&](const auto& visit) {
        tbb::parallel_for(std::size_t(0), tasks, [&](std::size_t task) {
            cancelled.check();
            const std::size_t end = std::min((task + 1) * triangles_per_task, triangles.size());
            for (std::size_t i = task * triangles_per_task; i < end; ++i) visit(std::uint32_t(i));
        });
    };
    // Counted first, then put where the counts say.
    std::vector<BandsOf::Range> ranges(triangles.size());
    std::vector<std::atomic<std::size_t>> next(bands + 1);
    for_each_triangle([&](std::uint32_t i) {
        ranges[i] = bands_of(triangles.corners[i]);
        for (std::uint32_t b = ranges[i].begin; b < ranges[i].end; ++b)
            next[b + 1].fetch_add(1, std::memory_order_relaxed);
    });
    first_.assign(bands + 1, 0);
    for (std::size_t b = 0; b < bands; ++b) first_[b + 1] = first_[b] + next[b + 1], next[b] = first_[b];
    if (first_.back() * sizeof(std::uint32_t) > memory_budget)
        throw InputError(
            fmt::format("the triangles of a ray-bundle of {} x {} rays take{} while it is built, more than "
                        "the{} allowed",
                        grid.columns, grid.rows, memory_text(double(first_.back()) * sizeof(std::uint32_t)),
                        memory_text(double(memory_budget))));
    binned_.resize(first_.back());
    for_each_triangle([&](std::uint32_t i) {
        for (std::uint32_t b = ranges[i].begin; b < ranges[i].end; ++b)
            binned_[next[b].fetch_add(1, std::memory_order_relaxed)] = i;
    });
}

void ScanForm::scan_rows(std::uint32_t begin, std::uint32_t end, HitBand& band) const {
    const std::size_t number = begin / rows_per_band_;
    for (std::size_t i = first_[number]; i < first_[number + 1]; ++i) {
        const std::uint32_t index = binned_[i];
        const ProjectedTriangle triangle(projection_, triangles_.corners[index]);
        const auto& p = triangle.corners();
        const Steps rows(std::max(double(begin), least(p[0].y, p[1].y, p[2].y)), most(p[0].y, p[1].y, p[2].y),
                         end);
        for (std::int64_t y = rows.from; y <= rows.to; ++y) {
            const Steps columns = columns_of(p, double(y), grid_.columns);
            const auto first = std::uint32_t(y - begin) * grid_.columns;
            for (std::int64_t x = columns.from; x <= columns.to; ++x)
                if (const auto hit = triangle.hit(double(x), double(y), index))
                    band.add(first + std::uint32_t(x), *hit);
        }
    }
}

}  // namespace mote::gathering
