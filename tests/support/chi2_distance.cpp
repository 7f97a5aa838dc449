#include "tests/support/chi2_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <vector>

#include "tests/support/failure_files.h"

namespace mote::tests {
namespace {

/// The counted bins; the last one is no event.
struct Counts {
    std::vector<Cell> cells;
    std::size_t outside = 0;  ///< samples beyond the domain, NaN among them
};

double bin_edge(const DistanceOptions& o, int i) { return o.lower + (o.upper - o.lower) * i / o.bins; }

Counts count_samples(const DistanceSampler& sampler, const DistanceOptions& o) {
    Counts counts{std::vector<Cell>(std::size_t(o.bins) + 1), 0};
    core::Rng rng(o.seed);
    for (std::size_t i = 0; i < o.samples; ++i) {
        const auto t = sampler(rng);
        if (!t) {
            counts.cells.back().observed += 1.0;
        } else if (*t >= o.lower && *t <= o.upper) {
            const int bin = int((*t - o.lower) / (o.upper - o.lower) * o.bins);
            counts.cells[std::size_t(std::min(bin, o.bins - 1))].observed += 1.0;
        } else {
            ++counts.outside;
        }
    }
    return counts;
}

/// Sets the expected counts and the integral; false where the function is no distribution function.
bool expect(const DistanceCdf& cdf, const DistanceOptions& o, std::vector<Cell>& cells, double& integral) {
    const double n = double(o.samples), start = cdf(o.lower);
    double before = start;
    bool rises = std::fabs(start) < 1e-9;
    for (int i = 0; i < o.bins; ++i) {
        const double after = cdf(bin_edge(o, i + 1));
        rises = rises && after >= before - 1e-12;
        cells[std::size_t(i)].expected = n * std::max(0.0, after - before);
        before = after;
    }
    integral = before - start;
    cells.back().expected = n * std::max(0.0, 1.0 - integral);
    return rises && integral <= 1.0 + 1e-6;
}

std::string write_table(const Counts& counts, const DistanceOptions& o) {
    return write_failure(o.name, [&](const std::filesystem::path& folder) {
        std::ofstream file(folder / "bins.csv");
        file << "from,to,expected,observed\n";
        for (int i = 0; i < o.bins; ++i)
            file << fmt::format("{},{},{},{}\n", bin_edge(o, i), bin_edge(o, i + 1),
                                counts.cells[std::size_t(i)].expected, counts.cells[std::size_t(i)].observed);
        file << fmt::format("no event,,{},{}\n", counts.cells.back().expected, counts.cells.back().observed)
             << fmt::format("outside,,0,{}\n", counts.outside);
    });
}

/// f at equal steps over [lower, upper], linear between them.
DistanceCdf interpolated(std::vector<double> values, double lower, double upper) {
    const auto table = std::make_shared<const std::vector<double>>(std::move(values));
    return [=](double t) {
        const double last = double(table->size() - 1);
        const double x = std::clamp((t - lower) / (upper - lower) * last, 0.0, last);
        const auto i = std::min(std::size_t(x), table->size() - 2);
        return (*table)[i] + (x - double(i)) * ((*table)[i + 1] - (*table)[i]);
    };
}

/// Running integral of f at steps + 1 points.
std::vector<double> running_integral(const std::function<double(double)>& f, double lower, double upper,
                                     int steps) {
    std::vector<double> sums(std::size_t(steps) + 1, 0.0);
    const double h = (upper - lower) / steps;
    for (int i = 0; i < steps; ++i)
        sums[std::size_t(i) + 1] = sums[std::size_t(i)] + h * f(lower + (i + 0.5) * h);
    return sums;
}

}  // namespace

Chi2Result chi2_distance_test(const DistanceSampler& sampler, const DistanceCdf& cdf,
                              const DistanceOptions& o) {
    Counts counts = count_samples(sampler, o);
    Chi2Result result;
    const bool distribution = expect(cdf, o, counts.cells, result.integral);
    const std::size_t impossible = impossible_cells(counts.cells, 1e-6);
    pearson(counts.cells, result);
    const double level = sidak_level(o.significance, std::size_t(o.tests));
    result.passed = distribution && impossible == 0 && counts.outside == 0 && result.degrees >= 1 &&
                    result.p_value >= level;
    result.message = fmt::format(
        "{}: chi2 = {:.1f} with {} degrees of freedom, p = {:.3g} (level {:.3g}); an event in {:.4f} of {} "
        "samples, {:.4f} expected; {} outside the domain; {} bins of zero probability were hit{}",
        o.name, result.statistic, result.degrees, result.p_value, level,
        1.0 - (counts.cells.back().observed + double(counts.outside)) / double(o.samples), o.samples,
        result.integral, counts.outside, impossible, distribution ? "" : "; not a distribution function");
    if (!result.passed && o.write_table) result.message += write_table(counts, o);
    return result;
}

DistanceCdf cdf_of_density(const std::function<double(double)>& density, double lower, double upper,
                           int steps) {
    return interpolated(running_integral(density, lower, upper, steps), lower, upper);
}

DistanceCdf cdf_of_rate(const std::function<double(double)>& sigma, double lower, double upper, int steps) {
    std::vector<double> values = running_integral(sigma, lower, upper, steps);
    for (double& v : values) v = -std::expm1(-v);
    return interpolated(std::move(values), lower, upper);
}

}  // namespace mote::tests
