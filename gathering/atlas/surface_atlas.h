// An atlas of the scene's surfaces: every side that reflects or emits light, cut into texels of nearly one
// area.
//
// Charts (charts.h) are rectangles of cells. A cell that holds less than half of its area of surface is
// joined to a neighbour, one that holds none refers to the nearest that does: so lookups and interpolation
// between cells meet texels of the surface alone, and need no guard band between charts.
#pragma once

#include <optional>

#include "core/objects/memory_budget.h"
#include "gathering/atlas/charts.h"
#include "gathering/atlas/surface_place.h"

namespace mote::gathering {

/// Side of a triangle: the front, where its normal points, or the back.
enum class SurfaceSide : std::uint8_t { front, back };

struct AtlasSettings {
    float texels_per_metre = 0.0f;  ///< 0: as many as `texel_budget` allows
    /// Budget of the texels of all sides together; more are refused.
    std::size_t texel_budget = std::size_t(1) << 17;
    float chart_cosine = 0.8f;        ///< of make_charts()
    core::MemoryBudget memory = {};   ///< of texels, and of what is kept for them
    std::size_t bytes_per_texel = 0;  ///< of the latter [B]
};

/// A piece of one side of a surface.
struct AtlasTexel {
    core::Vec3 position;          ///< on the surface, in the middle of the texel's largest part
    float area;                   ///< of the surface [m^2]
    core::Vec3 normal;            ///< mean shading normal, unit, on this side
    std::uint32_t triangle;       ///< that `position` lies on
    core::Vec3 geometric_normal;  ///< mean, unit, on this side
    SurfaceSide side;             ///< that it is a piece of
    bool whole;                   ///< one cell of a plane, and all of it is surface
    core::Vec2 barycentric;       ///< of `position` in its triangle
};

/// The texels, and which of them lies where.
class SurfaceAtlas {
  public:
    static constexpr std::uint32_t none = Charts::none;  ///< index of no texel

    /// Throws InputError where the density or the number of charts takes more texels than the budget, and
    /// says which density fits, and OutOfMemory where they exceed `memory`. `surfaces` and `shapes` must
    /// outlive the atlas.
    SurfaceAtlas(const SurfaceTriangles& surfaces, ShapeSpan shapes, const AtlasSettings& settings);

    std::span<const AtlasTexel> texels() const { return texels_; }  ///< chart by chart
    std::size_t size() const { return texels_.size(); }             ///< how many texels
    std::size_t charts() const { return charts_; }                  ///< how many charts
    float texels_per_metre() const { return texels_per_metre_; }    ///< along an edge, as requested or chosen
    const SurfaceTriangles& surfaces() const { return *surfaces_; }  ///< that it was made of
    ShapeSpan shapes() const { return shapes_; }                     ///< that the triangles belong to
    std::size_t memory_bytes() const;                                ///< [B]

    /// The texel at a place of a triangle; none where that side neither reflects nor emits.
    std::uint32_t texel(std::uint32_t triangle, float u, float v, SurfaceSide side) const {
        const TriangleCells& c = cells_of_[triangle];
        const std::uint32_t base = c.base[std::size_t(side)];
        if (base == none) return none;
        const core::Vec2 at = c.corner + u * c.edge_u + v * c.edge_v;
        const auto x = std::uint32_t(std::min(std::max(at.x, 0.0f), c.last_x));
        const auto y = std::uint32_t(std::min(std::max(at.y, 0.0f), c.last_y));
        return base + cells_[c.cells + y * (std::uint32_t(c.last_x) + 1) + x];
    }

    /// Four texels of one chart and their weights, which add up to 1.
    struct Blend {
        std::array<std::uint32_t, 4> texel;  ///< into texels(); one may occur more than once
        std::array<float, 4> weight;         ///< of each
    };
    /// Bilinear between the middles of cells, and linear on from there to the chart's border, where weights
    /// may be negative. Nothing where that side neither reflects nor emits.
    std::optional<Blend> blend(std::uint32_t triangle, float u, float v, SurfaceSide side) const;

    /// Steps of the barycentric coordinates over a cell's width and over its height.
    std::array<core::Vec2, 2> cell_steps(std::uint32_t triangle) const;

    /// The hit at the position of a texel, for its BSDF and its emission.
    core::SurfaceHit place(const AtlasTexel& texel) const {
        return surface_place(*surfaces_, shapes_, texel.triangle, texel.barycentric);
    }

  private:
    friend class AtlasBuilder;
    struct TriangleCells {
        core::Vec2 corner, edge_u, edge_v;              ///< in cells of the chart
        std::uint32_t cells = 0;                        ///< first of the chart in cells_
        float last_x = 0.0f, last_y = 0.0f;             ///< columns - 1, rows - 1
        std::array<std::uint32_t, 2> base{none, none};  ///< first texel of the chart, by side
    };
    const SurfaceTriangles* surfaces_;
    ShapeSpan shapes_;
    std::vector<TriangleCells> cells_of_;
    std::vector<std::uint32_t> cells_;  ///< texel of a cell, counted from the chart's first
    std::vector<AtlasTexel> texels_;
    std::size_t charts_ = 0;
    float texels_per_metre_ = 0.0f;
};

}  // namespace mote::gathering
