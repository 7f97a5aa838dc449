#include "gathering/ray_bundles/surface_points.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/math/morton.h"
#include "core/math/random.h"
#include "core/math/warp.h"

namespace mote::gathering {

using namespace core;

namespace {

/// The bits of i mirrored at the binary point, moved by `shift` around [0, 1).
float moved_radical_inverse(std::uint32_t i, std::uint32_t shift) {
    i = (i & 0x55555555u) << 1 | (i & 0xaaaaaaaau) >> 1, i = (i & 0x33333333u) << 2 | (i & 0xccccccccu) >> 2;
    i = (i & 0x0f0f0f0fu) << 4 | (i & 0xf0f0f0f0u) >> 4;
    return to_unit_float(std::uint32_t(__builtin_bswap32(i)) + shift);
}

}  // namespace

SurfacePoints::SurfacePoints(const SurfaceTriangles& triangles) {
    std::vector<std::uint64_t> codes(triangles.size());
    std::vector<double> areas(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        const auto& c = triangles.corners[i];
        areas[i] = triangle_area(c);
        if (!(areas[i] > 0.0) || !std::isfinite(areas[i])) continue;
        codes[i] = morton_code((c[0] + c[1] + c[2]) / 3.0f, triangles.bounds);
        order_.push_back(i);
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
    });
    below_.reserve(order_.size() + 1);
    for (const std::uint32_t i : order_) below_.push_back(area_), area_ += areas[i];
    below_.push_back(area_);
    guide_.resize(std::bit_ceil(order_.size() + 1));
    std::uint32_t index = 0;
    for (std::size_t i = 0; i < guide_.size(); ++i) {
        const double fraction = area_ * double(i) / double(guide_.size());
        while (index + 1 < order_.size() && below_[index + 1] <= fraction) ++index;
        guide_[i] = index;
    }
}

void SurfacePoints::sample(std::uint64_t set, std::uint32_t count, std::uint32_t begin, std::uint32_t end,
                           std::vector<SurfacePoint>& points) const {
    points.clear();
    if (order_.empty()) return;
    Rng rng(hash_keys(set, 0x706f696e7473ull));
    const double shift = double(rng.next_float()), fraction = 1.0 / double(count);
    const std::uint32_t turned = rng.next_u32();
    for (std::uint32_t i = begin; i < end; ++i) {
        const double at = (double(i) + shift) * fraction;
        std::uint32_t index = guide_[std::size_t(at * double(guide_.size()))];
        while (index + 1 < order_.size() && below_[index + 1] <= at * area_) ++index;
        const double within = (at * area_ - below_[index]) / (below_[index + 1] - below_[index]);
        const Vec2 uv = square_to_triangle(
            {std::clamp(float(within), 0.0f, one_minus_epsilon), moved_radical_inverse(i, turned)});
        points.push_back({order_[index], uv.x, uv.y});
    }
}

}  // namespace mote::gathering
