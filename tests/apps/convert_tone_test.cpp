// mote convert --tone: highlights of a PNG file keep their shape.
#include <cmath>

#include "core/film/tone.h"
#include "core/formats/pictures/image_file.h"
#include "core/math/srgb.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using mote::core::Bitmap, mote::core::Rgb;

namespace {

/// 8-bit green of each pixel of the row, converted with these options.
std::vector<int> converted(const TemporaryFolder& folder, std::vector<std::string> options) {
    options.insert(options.begin(), {"convert", "row.exr", "row.png"});
    const RunResult run = run_mote(folder, options);
    INFO(run.err);
    REQUIRE(run.exit_code == 0);
    std::vector<int> shown;
    for (const Rgb& p : mote::core::read_bitmap(folder.file("row.png"), true).pixels)
        shown.push_back(int(std::lround(255.0f * p.y)));
    return shown;
}

}  // namespace

TEST_CASE("a filmic curve keeps the shape of highlights that are white without it", "[command][tone]") {
    const TemporaryFolder folder;
    const std::vector<Rgb> row = {Rgb(0.0f), Rgb(0.01f), Rgb(0.18f), Rgb(1.0f),
                                  Rgb(2.0f), Rgb(4.0f),  Rgb(5.6f)};
    mote::core::ImageChannels image;
    image.width = int(row.size()), image.height = 1;
    image.add_rgb("", row);
    mote::core::write_exr(folder.file("row.exr"), image);

    const std::vector<int> plain = converted(folder, {}), filmic = converted(folder, {"--tone", "filmic"});
    CHECK(converted(folder, {"--tone", "linear"}) == plain);
    CHECK(std::vector<int>(plain.begin() + 3, plain.end()) == std::vector<int>(4, 255));
    // Values of the curve by hand, from 0.15, 0.5, 0.1, 0.2, 0.02 and 0.3 of Hable 2010, to three digits.
    const std::vector<float> by_hand = {0.0f, 0.00766f, 0.128f, 0.493f, 0.713f, 0.918f, 1.0f};
    for (std::size_t i = 0; i < row.size(); ++i)
        CHECK(std::abs(filmic[i] - int(mote::core::encode_srgb(by_hand[i]))) <= 1);
    // The exposure comes first.
    CHECK(converted(folder, {"--tone", "filmic", "--exposure", "1"})[3] == filmic[4]);
}

TEST_CASE("what is not finite is shown as such under every curve", "[command][tone]") {
    const TemporaryFolder folder;
    mote::core::ImageChannels image;
    image.width = 2, image.height = 1;
    image.add_rgb("", std::vector<Rgb>{Rgb(INFINITY), Rgb(NAN)});
    mote::core::write_exr(folder.file("row.exr"), image);
    for (const char* tone : {"linear", "filmic"})
        CHECK(converted(folder, {"--tone", tone}) == std::vector<int>(2, 0));  // magenta has no green
}

TEST_CASE("--tone is for pictures that are shown", "[command][tone][refusal]") {
    const TemporaryFolder folder;
    const RunResult exr = run_mote(folder, {"convert", "a.exr", "b.exr", "--tone", "filmic"});
    CHECK(exr.exit_code == 2);
    CHECK(exr.err.find("--tone is for PNG files and films") != std::string::npos);
    CHECK(run_mote(folder, {"convert", "room.gltf", "room.xml", "--tone", "filmic"}).exit_code == 2);
    CHECK(run_mote(folder, {"convert", "a.exr", "b.png", "--tone", "bright"}).exit_code == 2);
}
