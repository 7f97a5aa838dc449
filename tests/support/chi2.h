// Pearson's chi-square test of a sampling routine against the density it claims, over directions.
//
// Directions are counted in equal cells of (cos theta, phi); the expected counts are integrals of the density
// over the cells. Whatever falls outside (absorbed samples, delta parts, and directions beyond the cap) is
// one more cell, expected with the probability that the density leaves over: so a density that is off by a
// factor, or samples that get lost, are found as well. Cells with fewer than five expected samples are
// pooled.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/math/frame.h"
#include "core/math/random.h"
#include "tests/support/pearson.h"

namespace mote::tests {

/// One sample, or nothing for a sample without a smooth direction.
using DirectionSampler = std::function<std::optional<core::Vec3>(core::Rng&)>;
/// Claimed density per solid angle.
using DirectionDensity = std::function<double(const core::Vec3&)>;

struct Chi2Options {
    std::string name = "unnamed";  ///< of the folder written on failure
    int cos_cells = 16, phi_cells = 32;
    std::size_t samples = 160000;
    std::uint64_t seed = 1;
    double significance = 0.01;
    int tests = 1;  ///< how many tests of one family share the significance (Šidák's correction)
    /// The cells cover the cap 1 - cos <= `cap` around the z axis of this frame: 2 is the sphere. Narrow
    /// lobes need a small one.
    core::Frame frame;
    double cap = 2.0;
    int subdivisions = 1;     ///< least number of times a cell is halved each way for its integral
    bool write_table = true;  ///< on failure; planted errors write none
};

Chi2Result chi2_test(const DirectionSampler& sampler, const DirectionDensity& density,
                     const Chi2Options& options);

}  // namespace mote::tests
