#include "tests/support/chi2.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <vector>

#include "tests/support/failure_files.h"

namespace mote::tests {
namespace {

using core::Vec3;
constexpr double two_pi = 6.28318530717958647692;

/// h = 1 - cos(theta), phi; solid angle is dh dphi.
Vec3 direction(const core::Frame& frame, double h, double phi) {
    const double r = std::sqrt(std::max(0.0, h * (2.0 - h)));
    const core::Vec3d local(r * std::cos(phi), r * std::sin(phi), 1.0 - h);
    return Vec3(core::Vec3d(frame.s) * local.x + core::Vec3d(frame.t) * local.y +
                core::Vec3d(frame.n) * local.z);
}

/// Adaptive Gauss-Legendre quadrature (3 x 3 points) of the density over one cell.
class CellIntegral {
  public:
    CellIntegral(const DirectionDensity& density, const Chi2Options& o)
        : density_(density), frame_(o.frame), samples_(double(o.samples)), subdivisions_(o.subdivisions) {}

    double operator()(double h0, double h1, double p0, double p1) const {
        return refine(h0, h1, p0, p1, quadrature(h0, h1, p0, p1), 0);
    }

  private:
    double quadrature(double h0, double h1, double p0, double p1) const {
        static constexpr std::array<double, 3> x = {0.11270166537925831, 0.5, 0.88729833462074169};
        static constexpr std::array<double, 3> w = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
        double sum = 0.0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                sum +=
                    w[i] * w[j] * density_(direction(frame_, h0 + x[i] * (h1 - h0), p0 + x[j] * (p1 - p0)));
        return sum * (h1 - h0) * (p1 - p0);
    }
    double refine(double h0, double h1, double p0, double p1, double coarse, int depth) const {
        const double h = 0.5 * (h0 + h1), p = 0.5 * (p0 + p1);
        const std::array<double, 4> parts = {quadrature(h0, h, p0, p), quadrature(h, h1, p0, p),
                                             quadrature(h0, h, p, p1), quadrature(h, h1, p, p1)};
        const double fine = parts[0] + parts[1] + parts[2] + parts[3];
        // A fiftieth of the standard deviation of the fraction of samples in the cell.
        const double tolerance = 0.02 * std::sqrt(std::max(fine, 5.0 / samples_) / samples_);
        if (depth >= 8 || (depth >= subdivisions_ && std::fabs(fine - coarse) < tolerance)) return fine;
        return refine(h0, h, p0, p, parts[0], depth + 1) + refine(h, h1, p0, p, parts[1], depth + 1) +
               refine(h0, h, p, p1, parts[2], depth + 1) + refine(h, h1, p, p1, parts[3], depth + 1);
    }

    const DirectionDensity& density_;
    core::Frame frame_;
    double samples_;
    int subdivisions_;
};

/// The counted cells; the last one is everything outside.
std::vector<Cell> count_samples(const DirectionSampler& sampler, const Chi2Options& o) {
    std::vector<Cell> cells(std::size_t(o.cos_cells * o.phi_cells) + 1);
    core::Rng rng(o.seed);
    const core::Vec3d axis(o.frame.n);
    for (std::size_t i = 0; i < o.samples; ++i) {
        std::size_t cell = cells.size() - 1;
        if (const auto w = sampler(rng)) {
            const core::Vec3d difference = glm::normalize(core::Vec3d(*w)) - axis;
            const double h = 0.5 * glm::dot(difference, difference);  // 1 - cos, precise near the axis
            if (h < o.cap * (1.0 + 1e-7)) {
                double phi = std::atan2(glm::dot(core::Vec3d(*w), core::Vec3d(o.frame.t)),
                                        glm::dot(core::Vec3d(*w), core::Vec3d(o.frame.s)));
                if (phi < 0.0) phi += two_pi;
                const int row = std::min(int(h / o.cap * o.cos_cells), o.cos_cells - 1);
                const int column = std::min(int(phi / two_pi * o.phi_cells), o.phi_cells - 1);
                cell = std::size_t(row * o.phi_cells + column);
            }
        }
        cells[cell].observed += 1.0;
    }
    return cells;
}

void integrate_density(const DirectionDensity& density, const Chi2Options& o, std::vector<Cell>& cells) {
    Chi2Options careful = o;
    careful.subdivisions = std::max(6, o.subdivisions);
    const CellIntegral integral(density, o), careful_integral(density, careful);
    for (int row = 0; row < o.cos_cells; ++row)
        for (int column = 0; column < o.phi_cells; ++column) {
            const auto over = [&](const CellIntegral& f) {
                return double(o.samples) * f(row * o.cap / o.cos_cells, (row + 1) * o.cap / o.cos_cells,
                                             column * two_pi / o.phi_cells,
                                             (column + 1) * two_pi / o.phi_cells);
            };
            Cell& cell = cells[std::size_t(row * o.phi_cells + column)];
            cell.expected = over(integral);
            // Before samples are called impossible: the corner of a sharp border may lie between the points.
            if (cell.expected == 0.0 && cell.observed > 0.0) cell.expected = over(careful_integral);
        }
}

std::string write_table(const std::vector<Cell>& cells, const Chi2Options& o) {
    return write_failure(o.name, [&](const std::filesystem::path& folder) {
        std::ofstream file(folder / "cells.csv");
        file << "row,column,expected,observed\n";
        for (std::size_t i = 0; i + 1 < cells.size(); ++i)
            file << fmt::format("{},{},{},{}\n", int(i) / o.phi_cells, int(i) % o.phi_cells,
                                cells[i].expected, cells[i].observed);
        file << fmt::format("outside,,{},{}\n", cells.back().expected, cells.back().observed);
    });
}

}  // namespace

Chi2Result chi2_test(const DirectionSampler& sampler, const DirectionDensity& density, const Chi2Options& o) {
    std::vector<Cell> cells = count_samples(sampler, o);
    integrate_density(density, o, cells);
    Chi2Result result;
    const auto n = double(o.samples);
    for (const Cell& c : cells) result.integral += c.expected / n;
    cells.back().expected = n * std::max(0.0, 1.0 - result.integral);

    const std::size_t impossible = impossible_cells({cells.begin(), cells.end() - 1}, 0.0);
    // The quadrature is exact to far better than the spread of a count over all cells.
    const bool too_much = !(result.integral <= 1.0 + std::max(1e-4, 0.5 / std::sqrt(n)));
    // Samples that the density says cannot be lost: the density is normalised, and some are missing.
    const bool lost = cells.back().expected < 1e-4 * n && cells.back().observed > 5.0 + 2e-4 * n;

    pearson(cells, result);
    const double level = sidak_level(o.significance, std::size_t(o.tests));
    result.passed = impossible == 0 && !too_much && !lost && result.degrees >= 1 && result.p_value >= level;
    result.message = fmt::format(
        "{}: chi2 = {:.1f} with {} degrees of freedom, p = {:.3g} (level {:.3g}); integral {:.6f}; {} "
        "samples "
        "lost; {} cells of zero density were hit",
        o.name, result.statistic, result.degrees, result.p_value, level, result.integral,
        cells.back().observed, impossible);
    if (!result.passed && o.write_table) result.message += write_table(cells, o);
    return result;
}

}  // namespace mote::tests
