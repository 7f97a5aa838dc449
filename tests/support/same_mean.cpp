// The z-tests of render_statistics.h, and what they write when they fail.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "core/formats/pictures/image_file.h"
#include "tests/support/catch.h"
#include "tests/support/failure_files.h"
#include "tests/support/pearson.h"
#include "tests/support/render_statistics.h"

namespace mote::tests {

using namespace core;

namespace {

/// Upper quantile of the standard normal distribution, by bisection of erfc.
double normal_quantile(double upper_tail) {
    double low = 0.0, high = 40.0;
    for (int i = 0; i < 200; ++i) {
        const double mid = 0.5 * (low + high);
        (0.5 * std::erfc(mid / std::sqrt(2.0)) > upper_tail ? low : high) = mid;
    }
    return 0.5 * (low + high);
}

/// Signed: positive where a is brighter. NaN where a value is.
double z_of(const Estimate& a, const Estimate& b) {
    const double floor = 1e-10 * (a.mean * a.mean + b.mean * b.mean) + 1e-30;
    return (a.mean - b.mean) / std::sqrt(a.variance_of_mean + b.variance_of_mean + floor);
}

/// The larger deviation; NaN stays.
double worse(double worst, double z) {
    return std::isnan(worst) || std::fabs(z) <= worst ? worst : std::fabs(z);
}

/// One layer of a render.
struct LayerBlocks {
    const RenderStatistics& render;
    std::size_t layer;
    const std::vector<Estimate>& blocks() const { return render.blocks[layer]; }
};

/// value(i) of every block as a picture of blocks_x x blocks_y pixels.
void write_blocks(const std::filesystem::path& path, const RenderStatistics& size,
                  const std::function<double(std::size_t)>& value) {
    std::vector<Rgb> pixels;
    for (std::size_t i = 0; i < std::size_t(size.blocks_x * size.blocks_y); ++i)
        pixels.emplace_back(value(3 * i), value(3 * i + 1), value(3 * i + 2));
    ImageChannels image;
    image.width = size.blocks_x, image.height = size.blocks_y;
    image.add_rgb("", pixels);
    write_exr(path.string(), image);
}

void write_comparison(const std::filesystem::path& folder, const LayerBlocks& A, const LayerBlocks& B,
                      const std::string& report) {
    const auto &a = A.blocks(), &b = B.blocks();
    write_blocks(folder / "a.exr", A.render, [&](std::size_t i) { return a[i].mean; });
    write_blocks(folder / "b.exr", A.render, [&](std::size_t i) { return b[i].mean; });
    write_blocks(folder / "z.exr", A.render, [&](std::size_t i) { return z_of(a[i], b[i]); });
    std::ofstream(folder / "report.txt") << report << "\n";
    std::ofstream table(folder / "blocks.csv");
    table << "block_x,block_y,channel,mean_a,error_a,mean_b,error_b,z\n";
    for (std::size_t i = 0; i < a.size(); ++i)
        table << fmt::format("{},{},{},{},{},{},{},{}\n", i / 3 % std::size_t(A.render.blocks_x),
                             i / 3 / std::size_t(A.render.blocks_x), i % 3, a[i].mean,
                             std::sqrt(a[i].variance_of_mean), b[i].mean, std::sqrt(b[i].variance_of_mean),
                             z_of(a[i], b[i]));
}

}  // namespace

ZTest same_mean(const RenderStatistics& A, const std::string& a, const RenderStatistics& B,
                const std::string& b, OnFailure on_failure) {
    const auto la = A.layer(a), lb = B.layer(b);
    if (A.blocks_x != B.blocks_x || A.blocks_y != B.blocks_y)
        throw std::invalid_argument("the renders are not cut into the same blocks");
    const double level = sidak_level(0.01, A.blocks[la].size() + 3);
    ZTest result{A.non_finite == 0 && B.non_finite == 0, 0.0, normal_quantile(0.5 * level), ""};
    result.report = fmt::format("layers '{}' and '{}', {} and {} passes, non-finite {} and {}\n", a, b,
                                A.passes, B.passes, A.non_finite, B.non_finite);
    const auto check = [&](const std::string& what, const Estimate& x, const Estimate& y) {
        const double z = z_of(x, y);
        result.worst_z = worse(result.worst_z, z);
        if (!(std::fabs(z) <= result.critical_z) || what[0] == 'p')
            result.report +=
                fmt::format("  {}: {:.6g} +- {:.2g} against {:.6g} +- {:.2g}, z = {:.2f}\n", what, x.mean,
                            std::sqrt(x.variance_of_mean), y.mean, std::sqrt(y.variance_of_mean), z);
    };
    for (std::size_t c = 0; c < 3; ++c)
        check(fmt::format("picture channel {}", c), A.whole[la][c], B.whole[lb][c]);
    for (std::size_t i = 0; i < A.blocks[la].size(); ++i)
        check(fmt::format("block ({}, {}) channel {}", i / 3 % std::size_t(A.blocks_x),
                          i / 3 / std::size_t(A.blocks_x), i % 3),
              A.blocks[la][i], B.blocks[lb][i]);
    result.passed = result.passed && result.worst_z <= result.critical_z;
    result.report += fmt::format("  worst z {:.2f}, critical {:.2f}", result.worst_z, result.critical_z);
    if (!result.passed && on_failure == OnFailure::write && !A.planted && !B.planted)
        result.report += write_failure("", [&](const std::filesystem::path& folder) {
            write_comparison(folder, {A, la}, {B, lb}, result.report);
        });
    return result;
}

ZTest mean_is(const RenderStatistics& A, const std::string& a, double value) {
    const auto la = A.layer(a);
    const double level = sidak_level(0.01, 3);
    ZTest result{A.non_finite == 0, 0.0, normal_quantile(0.5 * level), ""};
    for (const Estimate& e : A.whole[la]) {
        const double z = z_of(e, {value, 0.0});
        result.worst_z = worse(result.worst_z, z);
        result.report += fmt::format("layer '{}': {:.6g} +- {:.2g} against {:.6g}, z = {:.2f}\n", a, e.mean,
                                     std::sqrt(e.variance_of_mean), value, z);
    }
    result.passed = result.passed && result.worst_z <= result.critical_z;
    return result;
}

void check_same_mean(const RenderStatistics& A, const std::string& a, const RenderStatistics& B,
                     const std::string& b, std::initializer_list<double> planted) {
    const ZTest test = same_mean(A, a, B, b);
    INFO(test.report);
    CHECK(test.passed);
    for (const double factor : planted) {
        INFO("layer '" << a << "' with a planted error of " << factor);
        CHECK_FALSE(same_mean(A.scaled(factor), a, B, b).passed);
    }
}

void check_mean_is(const RenderStatistics& A, const std::string& a, double value,
                   std::initializer_list<double> planted) {
    const ZTest test = mean_is(A, a, value);
    INFO(test.report);
    CHECK(test.passed);
    for (const double factor : planted) {
        INFO("layer '" << a << "' with a planted error of " << factor);
        CHECK_FALSE(mean_is(A.scaled(factor), a, value).passed);
    }
}

}  // namespace mote::tests
