// Chi-square tests: counted cells, Pearson's statistic with rare cells pooled, and the level of one test
// among several. chi2.h counts directions, chi2_distance.h distances.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mote::tests {

/// Numbers of samples.
struct Cell {
    double expected = 0.0, observed = 0.0;
};

struct Chi2Result {
    bool passed = false;
    double statistic = 0.0, p_value = 0.0;
    double integral = 0.0;  ///< of the density over the domain
    int degrees = 0;
    std::string message;  ///< one line for a test's report
};

/// Sets statistic, degrees and p_value: cells are sorted by their expectation and pooled from the rarest
/// until five samples are expected. Cells without expectation take no part; they are impossible_cells().
void pearson(std::vector<Cell> cells, Chi2Result& result);

/// Cells that were hit although no more than `negligible` samples are expected there.
std::size_t impossible_cells(const std::vector<Cell>& cells, double negligible);

/// Probability that a chi-square variable with `degrees` degrees of freedom is at least `statistic`.
double chi2_survival(double statistic, int degrees);

/// The level of each of `tests` independent tests that together fail with probability `significance` (Šidák's
/// correction).
double sidak_level(double significance, std::size_t tests);

}  // namespace mote::tests
