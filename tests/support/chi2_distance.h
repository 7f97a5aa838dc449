// Pearson's chi-square test of sampled distances against the distribution they claim.
//
// Distances are counted in equal bins of [lower, upper]; "no event" (the ray left the medium) is one more,
// expected with the probability that the distribution function leaves over at the upper end. So a density
// that is off by a factor is found, and a chance of no event that is wrong too. Bins with fewer than five
// expected samples are pooled. Two more things fail whatever the statistic: a sample outside the domain (NaN
// among them), and one in a bin where none is expected.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/math/random.h"
#include "tests/support/pearson.h"

namespace mote::tests {

/// One sample: a distance, or nothing for no event.
using DistanceSampler = std::function<std::optional<double>(core::Rng&)>;
/// Claimed probability of an event before t: rises from 0 at `lower`, and leaves the chance of no event over
/// at `upper`. Called with rising t.
using DistanceCdf = std::function<double(double t)>;

struct DistanceOptions {
    std::string name = "unnamed";  ///< of the folder written on failure
    double lower = 0.0, upper = 1.0;
    int bins = 128;
    std::size_t samples = 100000;
    std::uint64_t seed = 1;
    double significance = 0.01;
    int tests = 1;            ///< how many tests of one family share the significance (Šidák's correction)
    bool write_table = true;  ///< on failure; planted errors write none
};

/// `integral` of the result is the probability of an event within the domain.
Chi2Result chi2_distance_test(const DistanceSampler& sampler, const DistanceCdf& cdf,
                              const DistanceOptions& options);

/// The distribution function of a density [1/m] over [lower, upper], by the midpoint rule with `steps` equal
/// steps, linear between them. The density may integrate to less than one: the rest is the chance of no
/// event.
DistanceCdf cdf_of_density(const std::function<double(double t)>& density, double lower, double upper,
                           int steps = 20000);

/// The distribution function of the first event at the rate sigma(t) [1/m] over [lower, upper]: 1 -
/// exp(-integral of sigma), the integral by the midpoint rule.
DistanceCdf cdf_of_rate(const std::function<double(double t)>& sigma, double lower, double upper,
                        int steps = 20000);

}  // namespace mote::tests
