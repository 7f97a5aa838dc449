// The z-test of pictures: its level, its power, and what it leaves behind when it fails.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "core/formats/pictures/image_file.h"
#include "core/math/random.h"
#include "tests/support/catch.h"
#include "tests/support/failure_files.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

constexpr int columns = 5, rows = 4;
constexpr double error = 0.01;  ///< standard error of a block, at a mean of about one

/// Normal deviate from twelve uniform ones: its tails end at six standard deviations.
double deviate(core::Rng& rng) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += double(rng.next_float());
    return sum;
}

/// A made-up render: block i of channel c has the mean 1 + i / 100 + c, with noise.
RenderStatistics picture(std::uint64_t seed) {
    core::Rng rng(seed);
    RenderStatistics r;
    r.layers = {"beauty"}, r.blocks_x = columns, r.blocks_y = rows, r.passes = 16;
    r.blocks.emplace_back(), r.whole.emplace_back();
    for (int i = 0; i < columns * rows; ++i)
        for (int c = 0; c < 3; ++c) {
            r.blocks[0].push_back({1.0 + 0.01 * i + c + error * deviate(rng), error * error});
            r.whole[0][std::size_t(c)].mean += r.blocks[0].back().mean / (columns * rows);
        }
    for (Estimate& e : r.whole[0]) e.variance_of_mean = error * error / (columns * rows);
    return r;
}

/// Failures go to a folder of the test's own.
class FailureFolder {
  public:
    FailureFolder() { ::setenv("MOTE_TEST_FAILURES", folder_.path().c_str(), 1); }
    ~FailureFolder() {
        if (before_.empty())
            ::unsetenv("MOTE_TEST_FAILURES");
        else
            ::setenv("MOTE_TEST_FAILURES", before_.c_str(), 1);
    }
    std::size_t size() const { return folder_.size(); }

  private:
    static std::string current() {
        const char* value = std::getenv("MOTE_TEST_FAILURES");
        return value ? value : "";
    }
    std::string before_ = current();
    TemporaryFolder folder_;
};

std::size_t lines(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::size_t n = 0;
    for (std::string line; std::getline(file, line);) ++n;
    return n;
}

}  // namespace

TEST_CASE("pictures of the same mean pass, all but one in a hundred", "[statistics]") {
    int failed = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed)
        failed += !same_mean(picture(2 * seed), "beauty", picture(2 * seed + 1), "beauty", OnFailure::nothing)
                       .passed;
    // Ten are expected; 25 or more come with a chance of 5e-5, and a level left uncorrected fails hundreds.
    CHECK(failed < 25);
}

TEST_CASE("planted errors of a picture are caught", "[statistics][planted]") {
    const RenderStatistics a = picture(1), b = picture(2);
    CHECK(same_mean(a, "beauty", b, "beauty").passed);
    // Three per cent of the whole: the mean of 20 blocks is known to 0.3 %.
    CHECK_FALSE(same_mean(a.scaled(1.03), "beauty", b, "beauty").passed);
    CHECK_FALSE(same_mean(a, "beauty", b.scaled(1.03), "beauty").passed);
    SECTION("one block of one channel, by ten standard errors") {
        RenderStatistics wrong = b;
        wrong.blocks[0][17].mean += 10.0 * error;
        CHECK_FALSE(same_mean(a, "beauty", wrong, "beauty", OnFailure::nothing).passed);
    }
    SECTION("NaN, even where it was not counted") {
        RenderStatistics wrong = b;
        wrong.blocks[0][17].mean = std::numeric_limits<double>::quiet_NaN();
        CHECK_FALSE(same_mean(a, "beauty", wrong, "beauty", OnFailure::nothing).passed);
    }
    SECTION("another grid of blocks is refused") {
        RenderStatistics wrong = b;
        wrong.blocks_x = rows, wrong.blocks_y = columns;
        CHECK_THROWS_AS(same_mean(a, "beauty", wrong, "beauty"), std::invalid_argument);
    }
}

TEST_CASE("a comparison that fails writes everything", "[statistics]") {
    const FailureFolder folder;
    const RenderStatistics a = picture(1), b = picture(2);
    RenderStatistics wrong = b;
    wrong.blocks[0][3 * 7 + 1].mean += 1.0;  // column 2 of row 1, green

    const std::string report = same_mean(a, "beauty", wrong, "beauty").report;
    INFO(report);
    REQUIRE(folder.size() == 1);
    CHECK(report.find("block (2, 1) channel 1: ") != std::string::npos);
    const auto start = report.find("written to ");
    REQUIRE(start != std::string::npos);
    const std::filesystem::path where = report.substr(start + 11);
    CHECK(where.filename().string().find("a_comparison_that_fails_writes_everything-") == 0);

    const core::ImageChannels z = core::read_exr((where / "z.exr").string());
    REQUIRE(z.width == columns);
    REQUIRE(z.height == rows);
    CHECK(z.rgb("")[7].y < -50.0f);
    CHECK(std::fabs(z.rgb("")[7].x) < 5.0f);
    CHECK(core::read_exr((where / "a.exr").string()).rgb("")[7].x == float(a.blocks[0][21].mean));
    CHECK(core::read_exr((where / "b.exr").string()).rgb("")[7].y == float(wrong.blocks[0][22].mean));
    CHECK(lines(where / "blocks.csv") == 1 + 3 * columns * rows);
    CHECK(lines(where / "report.txt") >= 5);  // what was compared, three channels, the block
}

TEST_CASE("what passes or holds a planted error writes nothing", "[statistics]") {
    const FailureFolder folder;
    const RenderStatistics a = picture(1), b = picture(2);
    CHECK(same_mean(a, "beauty", b, "beauty").passed);
    CHECK_FALSE(same_mean(a.scaled(1.1), "beauty", b, "beauty").passed);
    CHECK_FALSE(same_mean(a, "beauty", b.scaled(1.1), "beauty").passed);
    RenderStatistics wrong = b;
    wrong.blocks[0][0].mean += 1.0;
    CHECK_FALSE(same_mean(a, "beauty", wrong, "beauty", OnFailure::nothing).passed);
    CHECK(folder.size() == 0);
}

TEST_CASE("a failure that cannot be written is still reported", "[statistics]") {
    const TemporaryFolder folder;
    std::ofstream(folder.file("occupied")) << "a file";
    ::setenv("MOTE_TEST_FAILURES", (folder.file("occupied") + "/below").c_str(), 1);
    RenderStatistics wrong = picture(2);
    wrong.blocks[0][0].mean += 1.0;
    const ZTest test = same_mean(picture(1), "beauty", wrong, "beauty");
    ::unsetenv("MOTE_TEST_FAILURES");
    CHECK_FALSE(test.passed);
    CHECK(test.report.find("nothing written: ") != std::string::npos);
}
