// Bounds of a grid's values on a coarse grid of cells, and the walk of a ray through those cells.
//
// Delta tracking needs an upper bound of the extinction along the ray; one bound for everything wastes
// lookups in thin parts, so space is divided into cells, each with the bound of its own trilinear support
// (Szirmay-Kalos et al. 2011; Novák et al. 2014). The lower bound serves residual ratio tracking. All
// coordinates are index space: voxel centres at integers; the box given at construction holds every position
// whose value differs from the outside's. Cells are cubes of 8 voxels or more: as small as a limit on their
// number allows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/math/vec.h"

namespace mote::media {

using Voxel = glm::i64vec3;

/// Value is float (grey) or Rgb (per channel).
template <typename Value>
class MajorantGrid {
  public:
    struct Range {
        Value lower, upper;
    };
    static constexpr std::int64_t max_cells = 1 << 18;

    /// Space without cells: the range holds everywhere.
    explicit MajorantGrid(const Range& everywhere) : outside_(everywhere) {}
    /// Cells over the positions from `lower` to `upper` (voxels, both included).
    MajorantGrid(const Voxel& lower, const Voxel& upper, const Range& outside);

    /// Building: every voxel of the box is reported once, alone or in a block, by its inclusive corners.
    /// Voxels that are not reported count as `background` in finish(). Parts beyond the box are ignored.
    template <typename ValueAt>  // Value(const Voxel&)
    void add_block(const Voxel& lower, const Voxel& upper, ValueAt&& value_at);
    void add_constant(const Voxel& lower, const Voxel& upper, const Value& value);
    void finish(const Value& background);

    /// Calls visit(range, t0, t1) -> bool (false stops) for consecutive pieces of origin + t * direction, t
    /// from t_begin to t_end; pieces in which the value is zero may be left out. Visits at most as many
    /// pieces as a straight line can meet, whatever the rounding.
    template <typename Visit>
    void walk(const core::Vec3d& origin, const core::Vec3d& direction, double t_begin, double t_end,
              Visit&& visit) const;

    /// The part of [t_begin, t_end] inside the box; false when there is none.
    bool clip(const core::Vec3d& origin, const core::Vec3d& direction, double& t_begin, double& t_end) const;

    bool has_cells() const { return !cells_.empty(); }
    const glm::ivec3& resolution() const { return resolution_; }
    std::int64_t edge() const { return edge_; }
    const Voxel& lower() const { return lower_; }
    const Voxel& upper() const { return upper_; }
    const Range& outside() const { return outside_; }
    /// Bounds over all of space.
    Range total() const;
    /// The sum of the cells' lower bounds over that of their upper ones: 1 for a constant, 0 where every cell
    /// touches vacuum.
    double certain_fraction() const;
    /// For tests that plant an error: every upper bound multiplied by `factor`.
    void scale_upper(float factor) {
        for (Range& r : cells_) r.upper *= factor;
    }

  private:
    /// Nearer than that a ray walks from cell to cell, even where they are empty.
    static constexpr int shortest_leap = 1;

    bool clip_with(const core::Vec3d& origin, const core::Vec3d& direction, const core::Vec3d& inverse,
                   double& t_begin, double& t_end) const;
    std::size_t cell_index(int x, int y, int z) const {
        return (std::size_t(z) * std::size_t(resolution_.y) + std::size_t(y)) * std::size_t(resolution_.x) +
               std::size_t(x);
    }
    /// Calls body(cell, support_lower, support_upper) for every cell whose support meets the block.
    template <typename Body>
    void for_each_cell(const Voxel& lower, const Voxel& upper, Body&& body);

    Voxel lower_{0}, upper_{0};
    glm::ivec3 resolution_{0};
    std::int64_t edge_ = 1;
    Range outside_;
    bool outside_is_zero_ = false;
    void find_distances();

    std::vector<Range> cells_;
    /// Distance [cells], along the axis on which it is farthest, of the nearest cell that is not empty: 0 for
    /// those themselves. A walk leaps over what lies nearer.
    std::vector<std::uint8_t> distance_;
    std::vector<double> covered_;  ///< voxels reported per cell; only while building
};

}  // namespace mote::media

#include "media/majorant_grid_impl.h"
