// Charts: groups of triangles that hang together and face nearly the same way, each laid flat into a
// rectangle. A wall of two triangles is one chart, and so is a wall of a thousand.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "gathering/ray_bundles/surface_triangles.h"

namespace mote::gathering {

/// A rectangle in a plane: what lies on it are triangles of one shape, projected along `n`.
struct Chart {
    core::Vec3 origin;                   ///< the rectangle's corner, in the plane
    core::Vec3 s, t, n;                  ///< unit, orthogonal; n is on the triangles' front
    float width = 0.0f, height = 0.0f;   ///< along s and t [m]
    std::uint32_t first = 0, count = 0;  ///< into Charts::triangles
    std::uint32_t shape = 0;             ///< of its triangles, in the order of SurfaceTriangles
};

/// All charts of a list of triangles.
struct Charts {
    /// Index of no chart.
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::vector<Chart> charts;             ///< in the order in which they were grown
    std::vector<std::uint32_t> triangles;  ///< chart by chart
    std::vector<std::uint32_t> chart_of;   ///< by triangle; none for those without area

    /// Its triangles, as indices into the list that they were made of.
    std::span<const std::uint32_t> of(const Chart& chart) const {
        return {triangles.data() + chart.first, chart.count};
    }
};

/// Grows charts over shared edges of one shape, beginning with the largest triangles. Normals of a chart
/// differ from that of its first triangle by `min_cosine` at most, which bounds how much smaller than the
/// surface its projection is.
Charts make_charts(const SurfaceTriangles& surfaces, float min_cosine = 0.8f);

}  // namespace mote::gathering
