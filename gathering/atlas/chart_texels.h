// The texels of one chart: what its triangles put into its cells, small cells joined to neighbours.
#pragma once

#include "gathering/atlas/surface_atlas.h"

namespace mote::gathering {

struct ChartTexels {
    std::vector<std::uint32_t> texel_of_cell;  ///< every cell has one
    std::vector<AtlasTexel> texels;            ///< of the front
};

/// `corners`: of each of the chart's triangles, in cells.
ChartTexels make_chart_texels(const SurfaceTriangles& surfaces, std::span<const std::uint32_t> triangles,
                              std::span<const std::array<core::Vec2, 3>> corners, std::uint32_t columns,
                              std::uint32_t rows);

}  // namespace mote::gathering
