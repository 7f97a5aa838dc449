// Renders with mean and variance, and the statistical test that compares two of them.
//
// Pixels of one pass are correlated in many-light methods, because they share VPLs. Variances are therefore
// measured over passes, which are independent: of every block of pixels, and of the whole picture.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "core/objects/registry.h"
#include "core/render/integrator.h"
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

    bool planted = false;  ///< holds an error on purpose: see OnFailure

    std::size_t layer(const std::string& name) const;  ///< throws std::out_of_range
    RenderStatistics scaled(double factor) const;      ///< a planted error, and marked as one
};

/// The picture's size is that of the scene's film.
struct RenderSpec {
    int block = 4;  ///< pixels
    std::uint32_t passes = 256;
    std::uint64_t seed = 1;
    /// Further layers, each the sum of some of the integrator's: name and terms.
    std::vector<std::pair<std::string, std::vector<std::string>>> sums = {};
    core::TransportSet cells = core::TransportSet::all();  ///< RenderOptions::cells
};

RenderStatistics render_statistics(const core::Scene& scene, const core::Integrator& integrator,
                                   const RenderSpec& spec);

struct ZTest {
    bool passed;
    double worst_z, critical_z;  ///< over all blocks and channels, and the picture's mean
    std::string report;          ///< written out on failure
};

/// Files that a failed comparison writes. One with a planted error is expected to fail: it never writes.
enum class OnFailure {
    write,  ///< everything, into a folder named in the report (see failure_files.h): a.exr, b.exr with the
            ///< means and z.exr with the signed z-scores, blocks as pixels; and blocks.csv, report.txt
    nothing
};

/// Do layers `a` of A and `b` of B have the same expectation? Two-sided z-tests of every block and channel
/// and of the picture's mean, at a level of 1 % for all of them together (Šidák's correction). A relative
/// error of 1e-5 passes even where there is no noise: rounding. Throws std::invalid_argument where the two
/// are not cut into the same blocks.
ZTest same_mean(const RenderStatistics& A, const std::string& a, const RenderStatistics& B,
                const std::string& b, OnFailure on_failure = OnFailure::write);

/// Test of the picture's mean against an exact value.
ZTest mean_is(const RenderStatistics& A, const std::string& a, double value);

/// CHECKs same_mean(), with its report, and that it would see A times each of `planted`.
void check_same_mean(const RenderStatistics& A, const std::string& a, const RenderStatistics& B,
                     const std::string& b, std::initializer_list<double> planted = {});
/// CHECKs mean_is() likewise.
void check_mean_is(const RenderStatistics& A, const std::string& a, double value,
                   std::initializer_list<double> planted = {});

}  // namespace mote::tests
