// Where several points lie on the map of a light: structure of arrays, branch-free, so that compilers make
// vector code of it. The map has a border of one texel, which continues it (ShadowMapView::neighbour), so
// that the four texels around a point are always neighbours in memory.
#pragma once

#include <array>

#include "core/math/vectorize.h"
#include "lights/shadow_maps/shadow_map_view.h"

namespace mote::lights {

/// Cells of N points.
template <int N>
struct alignas(64) ShadowMapCells {
    float x[N], y[N], z[N];  ///< in the frame of the view, from its origin [m]
    float distance[N];       ///< along the rays [m]
    float s[N], t[N];        ///< between the lower and the upper texel along each axis
    std::int32_t corner[N];  ///< the lower texel of both axes, counted in rows of size + 2
    float inside[N];         ///< 1 where the map reaches, else 0
};

namespace detail {

using core::max_of, core::min_of;

/// Coordinates on the map in [-1, 1]^2.
struct MapPoint {
    float u, v, inside;
};

template <ShadowMapView::Kind kind>
inline MapPoint project(float x, float y, float z, float half_extent) {
    using Kind = ShadowMapView::Kind;
    if constexpr (kind == Kind::octahedral || kind == Kind::hemispherical) {
        const float scale =
            1.0f / max_of(std::fabs(x) + std::fabs(y) + std::fabs(z), std::numeric_limits<float>::min());
        const float px = scale * x, py = scale * y;
        if constexpr (kind == Kind::hemispherical) return {px - py, px + py, z >= 0.0f ? 1.0f : 0.0f};
        const float fx = std::copysign(1.0f - std::fabs(py), px),
                    fy = std::copysign(1.0f - std::fabs(px), py);
        return {z >= 0.0f ? px : fx, z >= 0.0f ? py : fy, 1.0f};
    } else {
        const float scale = kind == Kind::parallel
                                ? 1.0f / half_extent
                                : 1.0f / max_of(z * half_extent, std::numeric_limits<float>::min());
        const float u = scale * x, v = scale * y;
        return {u, v, max_of(std::fabs(u), std::fabs(v)) <= 1.0f && z >= 0.0f ? 1.0f : 0.0f};
    }
}

template <ShadowMapView::Kind kind, int N>
void find_cells(const ShadowMapView& view, const float* px, const float* py, const float* pz,
                ShadowMapCells<N>& cells) {
    const core::Vec3 o = view.origin, s = view.frame.s, t = view.frame.t, n = view.frame.n;
    const float half_size = 0.5f * float(view.size), size = float(view.size), extent = view.half_extent;
    const std::int32_t row = view.size + 2;
    MOTE_INDEPENDENT_LANES
    for (int i = 0; i < N; ++i) {
        const float dx = px[i] - o.x, dy = py[i] - o.y, dz = pz[i] - o.z;
        const float x = dx * s.x + dy * s.y + dz * s.z;
        const float y = dx * t.x + dy * t.y + dz * t.z;
        const float z = dx * n.x + dy * n.y + dz * n.z;
        const MapPoint p = project<kind>(x, y, z, extent);
        const float u = p.u * half_size + (half_size + 0.5f), v = p.v * half_size + (half_size + 0.5f);
        const auto column = std::int32_t(max_of(min_of(u, size), 0.0f));
        const auto line = std::int32_t(max_of(min_of(v, size), 0.0f));
        cells.x[i] = x, cells.y[i] = y, cells.z[i] = z;
        cells.distance[i] = kind == ShadowMapView::Kind::parallel ? z : std::sqrt(x * x + y * y + z * z);
        cells.s[i] = u - float(column), cells.t[i] = v - float(line);
        cells.corner[i] = line * row + column;
        cells.inside[i] = p.inside;
    }
}

}  // namespace detail

/// Points at the light itself lie somewhere, at distance 0. A NaN in a point leads to texels of the map with
/// fractions that are NaN.
template <int N>
void find_cells(const ShadowMapView& view, const float* x, const float* y, const float* z,
                ShadowMapCells<N>& cells) {
    using Kind = ShadowMapView::Kind;
    if (view.kind == Kind::octahedral)
        detail::find_cells<Kind::octahedral>(view, x, y, z, cells);
    else if (view.kind == Kind::hemispherical)
        detail::find_cells<Kind::hemispherical>(view, x, y, z, cells);
    else if (view.kind == Kind::perspective)
        detail::find_cells<Kind::perspective>(view, x, y, z, cells);
    else
        detail::find_cells<Kind::parallel>(view, x, y, z, cells);
}

}  // namespace mote::lights
