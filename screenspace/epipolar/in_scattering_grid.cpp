#include "screenspace/epipolar/in_scattering_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mote::screenspace {

using namespace core;

InScatteringGrid::InScatteringGrid(const FilmRectangle& frame, double spacing, const Vec2d& shift,
                                   float depth_tolerance, const InScatteringSource& source, const Loop& loop)
    : frame_(frame),
      origin_(frame.lower + (shift - 1.0) * spacing),
      spacing_(spacing),
      depth_tolerance_(depth_tolerance) {
    if (!(spacing > 0.0)) throw std::invalid_argument("in-scattering grid: the spacing must be positive");
    columns_ = int(std::floor((frame.upper.x - origin_.x) / spacing)) + 2;
    rows_ = int(std::floor((frame.upper.y - origin_.y) / spacing)) + 2;
    samples_.resize(std::size_t(columns_) * std::size_t(rows_));
    std::vector<std::uint64_t> marched(std::size_t(rows_), 0);
    loop(rows_, [&](int row) {
        const auto task = source.start();
        for (int column = 0; column < columns_; ++column) {
            Sample& s = samples_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
            // The outermost samples may lie outside: their rays are those of the border.
            const Vec2d at = film(column, row);
            s.ray = task->ray(at), s.end = task->end_of(at), s.light = Rgb(0.0f);
            if (s.end.dark()) continue;
            s.light = task->march(at, s.end).radiance / s.end.weight;
            ++marched[std::size_t(row)];
        }
    });
    for (const std::uint64_t n : marched) marched_ += n;
}

/// Tent weights over the cells within `reach` of the position, of the samples that continue the surface.
std::optional<Rgb> InScatteringGrid::weighted(const Vec2d& cell, const RayEnd& end, int reach) const {
    const int x0 = int(std::floor(cell.x)), y0 = int(std::floor(cell.y));
    Vec3d sum(0.0);
    double weight = 0.0;
    for (int y = std::max(0, y0 - reach + 1); y <= std::min(rows_ - 1, y0 + reach); ++y)
        for (int x = std::max(0, x0 - reach + 1); x <= std::min(columns_ - 1, x0 + reach); ++x) {
            const Sample& s = samples_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)];
            const double w = (1.0 - std::abs(x - cell.x) / reach) * (1.0 - std::abs(y - cell.y) / reach);
            if (!(w > 0.0) ||
                !continues(end, s.end.distance, s.end.surface, depth_tolerance_, [&] { return s.ray; }))
                continue;
            sum += w * Vec3d(s.light), weight += w;
        }
    if (!(weight > 1e-3)) return std::nullopt;
    return end.weight * Rgb(sum / weight);
}

std::optional<Rgb> InScatteringGrid::light_at(const Vec2d& film, const RayEnd& end) const {
    if (end.dark()) return Rgb(0.0f);
    const Vec2d cell = (film - origin_) / spacing_;
    if (const auto light = weighted(cell, end, 1)) return light;
    return weighted(cell, end, 2);
}

std::vector<Vec2d> InScatteringGrid::marched_at() const {
    std::vector<Vec2d> places;
    for (int row = 0; row < rows_; ++row)
        for (int column = 0; column < columns_; ++column)
            if (!samples_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)].end.dark())
                places.push_back(film(column, row));
    return places;
}

}  // namespace mote::screenspace
