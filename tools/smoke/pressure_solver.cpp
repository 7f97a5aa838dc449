#include "tools/smoke/pressure_solver.h"

#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace mote::tools {

namespace {

constexpr int smoothing_sweeps = 2;
constexpr int coarsest_sweeps = 40;

bool can_halve(const GridSize& s) {
    return s.x % 2 == 0 && s.y % 2 == 0 && s.z % 2 == 0 && std::min({s.x, s.y, s.z}) >= 8;
}

/// Contribution of the neighbours to a cell's equation: their sum, and the number of faces that carry a flux.
struct Neighbours {
    float sum = 0.0f, faces = 0.0f;
};

Neighbours neighbours(const GridSize& n, const BoxSides& sides, const std::vector<float>& p, int i, int j,
                      int k) {
    const std::size_t c = n.index(i, j, k);
    const std::size_t row = std::size_t(n.x), slice = row * std::size_t(n.y);
    Neighbours r;
    const auto face = [&](bool inside, std::size_t neighbour, int axis, bool upper) {
        if (inside)
            r.sum += p[neighbour], r.faces += 1.0f;
        else if (sides.open(axis, upper))
            r.faces += 1.0f;  // the pressure outside is zero
    };
    face(i > 0, c - 1, 0, false), face(i + 1 < n.x, c + 1, 0, true);
    face(j > 0, c - row, 1, false), face(j + 1 < n.y, c + row, 1, true);
    face(k > 0, c - slice, 2, false), face(k + 1 < n.z, c + slice, 2, true);
    return r;
}

/// Cells that have all six neighbours need no questions: most of the grid, and most of the time.
float inner_sum(const std::vector<float>& p, std::size_t c, std::size_t row, std::size_t slice) {
    return p[c - 1] + p[c + 1] + p[c - row] + p[c + row] + p[c - slice] + p[c + slice];
}

}  // namespace

PressureSolver::PressureSolver(const GridSize& size, const BoxSides& sides) : size_(size), sides_(sides) {
    for (GridSize s = size; can_halve(s);) {
        s = {s.x / 2, s.y / 2, s.z / 2};
        coarse_.push_back({s, std::vector<float>(s.cells()), std::vector<float>(s.cells())});
    }
}

void PressureSolver::solve(std::vector<float>& pressure, const std::vector<float>& divergence, int cycles) {
    for (int i = 0; i < cycles; ++i) cycle(0, pressure, divergence);
}

void PressureSolver::cycle(std::size_t level, std::vector<float>& solution,
                           const std::vector<float>& right_side) {
    const GridSize size = level == 0 ? size_ : coarse_[level - 1].size;
    if (level == coarse_.size()) {
        smooth(size, solution, right_side, coarsest_sweeps);
        return;
    }
    Level& below = coarse_[level];
    smooth(size, solution, right_side, smoothing_sweeps);
    restrict_residual(size, solution, right_side, below);
    std::fill(below.solution.begin(), below.solution.end(), 0.0f);
    cycle(level + 1, below.solution, below.right_side);
    add_interpolated(size, solution, below);
    smooth(size, solution, right_side, smoothing_sweeps);
}

void PressureSolver::smooth(const GridSize& n, std::vector<float>& p, const std::vector<float>& rhs,
                            int sweeps) const {
    const std::size_t row = std::size_t(n.x), slice = row * std::size_t(n.y);
    for (int half = 0; half < 2 * sweeps; ++half) {
        for_each_row(n, [&](int j, int k) {
            const bool inner_row = j > 0 && j + 1 < n.y && k > 0 && k + 1 < n.z;
            for (int i = (j + k + half) & 1; i < n.x; i += 2) {
                const std::size_t c = n.index(i, j, k);
                if (inner_row && i > 0 && i + 1 < n.x) {
                    p[c] = (inner_sum(p, c, row, slice) - rhs[c]) * (1.0f / 6.0f);
                } else {
                    const Neighbours r = neighbours(n, sides_, p, i, j, k);
                    p[c] = (r.sum - rhs[c]) / r.faces;
                }
            }
        });
    }
}

float PressureSolver::laplacian(const GridSize& n, const std::vector<float>& p, int i, int j, int k) const {
    const std::size_t c = n.index(i, j, k);
    if (i > 0 && i + 1 < n.x && j > 0 && j + 1 < n.y && k > 0 && k + 1 < n.z) {
        const std::size_t row = std::size_t(n.x);
        return inner_sum(p, c, row, row * std::size_t(n.y)) - 6.0f * p[c];
    }
    const Neighbours r = neighbours(n, sides_, p, i, j, k);
    return r.sum - r.faces * p[c];
}

void PressureSolver::restrict_residual(const GridSize& fine, const std::vector<float>& solution,
                                       const std::vector<float>& right_side, Level& coarse) const {
    for_each_row(coarse.size, [&](int j, int k) {
        for (int i = 0; i < coarse.size.x; ++i) {
            float sum = 0.0f;
            for (int c = 0; c < 8; ++c) {
                const int fi = 2 * i + (c & 1), fj = 2 * j + ((c >> 1) & 1), fk = 2 * k + (c >> 2);
                sum += right_side[fine.index(fi, fj, fk)] - laplacian(fine, solution, fi, fj, fk);
            }
            // The mean of eight, times four: the coarse equation is written for cells of size 1, and its own
            // are twice as large, so that its Laplacian is four times too small.
            coarse.right_side[coarse.size.index(i, j, k)] = 0.5f * sum;
        }
    });
}

void PressureSolver::add_interpolated(const GridSize& fine, std::vector<float>& solution,
                                      const Level& coarse) const {
    for_each_row(fine, [&](int j, int k) {
        for (int i = 0; i < fine.x; ++i) {
            const core::Vec3 p((float(i) + 0.5f) * 0.5f, (float(j) + 0.5f) * 0.5f, (float(k) + 0.5f) * 0.5f);
            solution[fine.index(i, j, k)] += Stencil(coarse.size, p).gather(coarse.solution);
        }
    });
}

double PressureSolver::residual_norm(const std::vector<float>& pressure,
                                     const std::vector<float>& divergence) const {
    const double sum = tbb::parallel_deterministic_reduce(
        tbb::blocked_range<int>(0, size_.z), 0.0,
        [&](const tbb::blocked_range<int>& range, double partial) {
            for (int k = range.begin(); k < range.end(); ++k)
                for (int j = 0; j < size_.y; ++j)
                    for (int i = 0; i < size_.x; ++i) {
                        const double r = double(divergence[size_.index(i, j, k)]) -
                                         double(laplacian(size_, pressure, i, j, k));
                        partial += r * r;
                    }
            return partial;
        },
        [](double a, double b) { return a + b; });
    return std::sqrt(sum / double(size_.cells()));
}

}  // namespace mote::tools
