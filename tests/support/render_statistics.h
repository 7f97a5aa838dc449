// Renders with mean and variance, and the statistical test that compares two of them.
//
// Pixels of one pass are correlated in many-light methods, because they share VPLs. Variances are therefore
// measured over passes, which are independent: of every block of pixels, and of the whole picture.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/render/integrator.h"
#include "core/scene/registry.h"
#include "core/scene/scene.h"

namespace mote::tests {

/// Everything registered, built once per test program.
const core::Registry& registry();

/// Scene from XML text, with a square film of `size` pixels put into its sensor. Relative files are looked up
/// in `folder`.
std::unique_ptr<core::Scene> scene_from(std::string xml, int size = 16, const std::string& folder = ".");
/// An integrator from its XML element.
std::shared_ptr<const core::Integrator> integrator_from(const std::string& xml);

struct Estimate {
    double mean = 0.0, variance_of_mean = 0.0;
};

/// Per layer, channel and block of pixels: mean over passes and the variance of that mean.
struct RenderStatistics {
    std::vector<std::string> layers;  ///< the last one is "beauty", the sum of all
    int blocks_x = 0, blocks_y = 0;
    std::uint32_t passes = 0;
    std::uint64_t non_finite = 0;
    std::vector<std::vector<Estimate>> blocks;   ///< [layer][(block_y * blocks_x + block_x) * 3 + channel]
    std::vector<std::array<Estimate, 3>> whole;  ///< [layer][channel]: the mean of all pixels

    std::size_t layer(const std::string& name) const;  ///< throws std::out_of_range
    RenderStatistics scaled(double factor) const;      ///< a planted error
};

/// The picture's size is that of the scene's film.
struct RenderSpec {
    int block = 4;  ///< pixels
    std::uint32_t passes = 256;
    std::uint64_t seed = 1;
};

RenderStatistics render_statistics(const core::Scene& scene, const core::Integrator& integrator,
                                   const RenderSpec& spec);

struct ZTest {
    bool passed;
    double worst_z, critical_z;  ///< over all blocks and channels, and the picture's mean
    std::string report;          ///< written out on failure
};

/// Do layers `a` of A and `b` of B have the same expectation? Two-sided z-tests of every block and channel
/// and of the picture's mean, at a level of 1 % for all of them together (Sidak). `variance_floor` keeps
/// blocks without noise from failing by rounding: it is relative to the squared mean, (1e-5)^2.
ZTest same_mean(const RenderStatistics& A, const std::string& a, const RenderStatistics& B,
                const std::string& b);

/// The same against an exact value for the picture's mean.
ZTest mean_is(const RenderStatistics& A, const std::string& a, double value);

}  // namespace mote::tests
