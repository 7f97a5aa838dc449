#include "gathering/micro_buffers/brdf_warp.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/objects/error.h"

namespace mote::gathering {

using namespace core;

namespace {

/// Cumulative distribution of weights in [0, 1]; even where all are zero.
void accumulate(std::span<const double> weights, std::span<float> cdf) {
    double total = 0.0, sum = 0.0;
    for (const double w : weights) total += w;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        cdf[i] = total > 0.0 ? float(sum / total) : float(i) / float(weights.size());
        sum += weights[i];
    }
    cdf[weights.size()] = 1.0f;
}

/// The last cell that begins at or before `u` and is not empty.
std::uint32_t cell_at(std::span<const float> cdf, float u) {
    const auto above = std::upper_bound(cdf.begin() + 1, cdf.end() - 1, u);
    return std::uint32_t(above - cdf.begin() - 1);
}

float within(std::span<const float> cdf, std::uint32_t cell, float u) {
    const float width = cdf[cell + 1] - cdf[cell];
    const float part = width > 0.0f ? std::clamp((u - cdf[cell]) / width, 0.0f, 1.0f) : 0.5f;
    return (float(cell) + part) / float(cdf.size() - 1);
}

float cdf_at(std::span<const float> cdf, float position) {
    const float at = std::clamp(position, 0.0f, 1.0f) * float(cdf.size() - 1);
    const auto cell = std::min(std::uint32_t(at), std::uint32_t(cdf.size() - 2));
    return lerp(cdf[cell], cdf[cell + 1], at - float(cell));
}

}  // namespace

BrdfWarp::BrdfWarp(std::uint32_t cells)
    : cells_(cells),
      values_(std::size_t(cells) * cells),
      marginal_(cells + 1),
      conditional_(std::size_t(cells) * (cells + 1)) {
    if (cells == 0 || cells > 256)
        throw InputError(fmt::format("a warp has 1 to 256 cells a side, not {}", cells));
}

void BrdfWarp::integrate() {
    std::vector<double> columns(cells_), column(cells_);
    Vec3d sum(0.0);
    for (std::uint32_t u = 0; u < cells_; ++u) {
        for (std::uint32_t v = 0; v < cells_; ++v) {
            column[v] = double(luminance(values_[u * cells_ + v]));
            columns[u] += column[v], sum += Vec3d(values_[u * cells_ + v]);
        }
        total_ += columns[u];
        accumulate(column, std::span(conditional_).subspan(u * (cells_ + 1), cells_ + 1));
    }
    accumulate(columns, marginal_);
    integral_ = Rgb(sum * (double(pi) / double(cells_ * cells_)));
}

std::uint32_t BrdfWarp::column_of(float x) const { return cell_at(marginal_, x); }

std::uint32_t BrdfWarp::cell_of(std::uint32_t column, float y) const {
    return cell_at(std::span(conditional_).subspan(column * (cells_ + 1), cells_ + 1), y);
}

float BrdfWarp::conditional(std::uint32_t column, float v) const {
    return cdf_at(std::span(conditional_).subspan(column * (cells_ + 1), cells_ + 1), v);
}

Vec2 BrdfWarp::to_cosine_square(const Vec2& warped) const {
    const std::uint32_t column = column_of(warped.x);
    const auto cdf = std::span(conditional_).subspan(column * (cells_ + 1), cells_ + 1);
    // C^-1(y | u(x)) and M^-1(x).
    return {within(marginal_, column, warped.x), within(cdf, cell_of(column, warped.y), warped.y)};
}

Vec2 BrdfWarp::to_warped_square(const Vec2& cosine) const {
    const auto column = std::min(std::uint32_t(std::max(cosine.x, 0.0f) * float(cells_)), cells_ - 1);
    return {cdf_at(marginal_, cosine.x), conditional(column, cosine.y)};
}

void BrdfWarp::warp_box(const Vec2& lower, const Vec2& upper, Vec2& warped_lower, Vec2& warped_upper) const {
    const auto column_at = [&](float u) {
        return std::min(std::uint32_t(std::clamp(u, 0.0f, 1.0f) * float(cells_)), cells_ - 1);
    };
    warped_lower = {cdf_at(marginal_, lower.x), 1.0f};
    warped_upper = {cdf_at(marginal_, upper.x), 0.0f};
    for (std::uint32_t c = column_at(lower.x), last = column_at(upper.x); c <= last; ++c) {
        if (!(marginal_[c + 1] > marginal_[c])) continue;
        warped_lower.y = std::min(warped_lower.y, conditional(c, lower.y));
        warped_upper.y = std::max(warped_upper.y, conditional(c, upper.y));
    }
}

void BrdfWarp::fill_directions(std::uint32_t side, const Vec2& place, RayDirections& rays) const {
    rays.resize(side);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        const Vec2 at = (Vec2(float(i % side), float(i / side)) + place) / float(side);
        rays.set(i, square_to_hemisphere(to_cosine_square(at)));
    }
}

void BrdfWarp::fill_weights(std::uint32_t side, std::span<Rgb> weights) const {
    const float cell = 1.0f / float(side * side);
    for (std::uint32_t i = 0; i < side * side; ++i) {
        weights[i] = Rgb(0.0f);
        if (black()) continue;
        const std::uint32_t column = column_of((float(i % side) + 0.5f) / float(side));
        const Rgb& f = values_[column * cells_ + cell_of(column, (float(i / side) + 0.5f) / float(side))];
        // f cos / density: the cell's colour, with the luminance of the whole.
        if (luminance(f) > 0.0f) weights[i] = f * (cell * luminance(integral_) / luminance(f));
    }
}

}  // namespace mote::gathering
