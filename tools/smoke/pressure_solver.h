// The Poisson equation of the pressure on a box of cells, by geometric multigrid.
//
// Cell-centred, red-black Gauss-Seidel smoothing, averages down, trilinear interpolation up (Briggs, Henson
// and McCormick 2000, chapters 3 and 4). Walls let nothing through (zero normal derivative); an open side has
// pressure zero just outside. Same bits for any number of threads: cells of one colour never read each other.
#pragma once

#include "tools/smoke/dense_grid.h"

namespace mote::tools {

struct BoxSides {
    bool open_sides = true;  ///< x and z
    bool open_top = true;    ///< +y; the floor is always a wall
    bool open(int axis, bool upper) const { return axis == 1 ? upper && open_top : open_sides; }
};

class PressureSolver {
  public:
    /// Every dimension must be at least 8 and even often enough to be halved down to 8 to 15 or an odd
    /// number; coarser levels exist only as far as all three can be halved.
    PressureSolver(const GridSize& size, const BoxSides& sides);

    /// Improves `pressure` by `cycles` V-cycles so that laplacian(pressure) = divergence, cells of size 1.
    void solve(std::vector<float>& pressure, const std::vector<float>& divergence, int cycles);

    /// Root mean square over cells of divergence - laplacian(pressure).
    double residual_norm(const std::vector<float>& pressure, const std::vector<float>& divergence) const;

  private:
    struct Level {
        GridSize size;
        std::vector<float> solution, right_side;
    };
    void cycle(std::size_t level, std::vector<float>& solution, const std::vector<float>& right_side);
    void smooth(const GridSize& size, std::vector<float>& solution, const std::vector<float>& right_side,
                int sweeps) const;
    void restrict_residual(const GridSize& fine, const std::vector<float>& solution,
                           const std::vector<float>& right_side, Level& coarse) const;
    void add_interpolated(const GridSize& fine, std::vector<float>& solution, const Level& coarse) const;
    float laplacian(const GridSize& size, const std::vector<float>& p, int i, int j, int k) const;

    GridSize size_;
    BoxSides sides_;
    std::vector<Level> coarse_;  // level 1 and up; level 0 belongs to the caller
};

}  // namespace mote::tools
