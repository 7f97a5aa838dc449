// Makes a SurfaceAtlas: charts, the size of their cells, the texels that the cells make.
#pragma once

#include "gathering/atlas/surface_atlas.h"
#include "gathering/atlas/surface_sides.h"

namespace mote::gathering {

class AtlasBuilder {
  public:
    AtlasBuilder(SurfaceAtlas& atlas, const AtlasSettings& settings);
    void build();

  private:
    /// Cells of a chart at a density. They are stretched to fill the rectangle, from 0.7 to 1.41 of their
    /// size along an edge (a chart that is smaller has smaller ones), so areas lie within a factor of two of
    /// the requested one.
    struct Grid {
        std::uint32_t columns, rows;
        std::size_t cells() const { return std::size_t(columns) * rows; }
    };
    Grid grid(const Chart& chart, float density) const;
    /// Sides times cells of all charts.
    std::size_t cells_at(float density) const;
    float density_for(std::size_t budget) const;
    void check_budget() const;
    void add_chart(const Chart& chart);

    SurfaceAtlas& atlas_;
    AtlasSettings settings_;
    Charts charts_;
    std::vector<SurfaceSides> sides_;  ///< by shape
    float density_ = 0.0f;
};

}  // namespace mote::gathering
