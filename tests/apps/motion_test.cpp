// Motion vectors and ids of sequences, and what denoising makes of them: a ball that moves before a wall.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using mote::core::ImageChannels, mote::core::Rgb;
namespace fs = std::filesystem;

namespace {

constexpr int width = 48, height = 36;
constexpr double fov = 40.0, distance = 6.0;
/// [pixels]
const double focal = 0.5 * width / std::tan(0.5 * fov * M_PI / 180.0);

/// `t`: the ball's place along x, `c`: the camera's [m].
struct Folder : TemporaryFolder {
    Folder() {
        write_file(
            file("scene.xml"),
            fmt::format(R"(<scene version="3.0.0"><default name="t" value="0"/><default name="c" value="0"/>
            <integrator type="path"/><sensor type="perspective"><float name="fov" value="{}"/><film type="hdrfilm">
            <integer name="width" value="{}"/><integer name="height" value="{}"/><rfilter type="box"/></film>
            <transform name="to_world"><lookat origin="$c, 0, {}" target="$c, 0, 0" up="0, 1, 0"/></transform></sensor>
            <shape type="rectangle"><transform name="to_world"><scale x="1.9" y="1.3"/><translate z="-1"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.05"/></bsdf></shape>
            <shape type="sphere"><transform name="to_world"><scale value="0.6"/><translate x="$t"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.9"/></bsdf></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="8"/><rotate x="1" angle="90"/>
            <translate x="-20" y="15" z="10"/></transform><emitter type="area"><rgb name="radiance" value="20, 10, 5"/></emitter></shape>
            <shape type="rectangle"><transform name="to_world"><scale value="8"/><rotate x="1" angle="90"/>
            <translate x="20" y="15" z="10"/></transform><emitter type="area"><rgb name="radiance" value="5, 10, 20"/></emitter></shape>
            </scene>)",
                        fov, width, height, distance));
    }
    void mote(const std::vector<std::string>& arguments) const {
        const RunResult r = run_mote(*this, arguments);
        INFO(r.err);
        REQUIRE(r.exit_code == 0);
    }
    void render(const std::vector<std::string>& more) const {
        std::vector<std::string> all = {"render", "scene.xml", "-t", "1", "--auxiliary", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        mote(all);
    }
    ImageChannels picture(const std::string& name) const { return mote::core::read_exr(file(name)); }
};

constexpr float ball = 2.0f;  // its number

std::vector<float> plane(const ImageChannels& image, const std::string& channel) {
    const auto* values = image.find(channel);
    CAPTURE(channel);
    REQUIRE(values);
    return *values;
}

bool same_bits(const ImageChannels& a, const ImageChannels& b) {
    return a.names == b.names &&
           std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(),
                      [](const auto& x, const auto& y) {
                          return std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
                      });
}

/// Copies of frames without some layers; or, for all others, without any but colours and with motion vectors
/// of zero.
void strip(const Folder& folder, const std::string& from, const std::string& to,
           const std::vector<std::string>& layers, bool blind = false) {
    for (int i = 0; i < 8; ++i) {
        const ImageChannels image = folder.picture(fmt::format("{}.{:04}.exr", from, i));
        ImageChannels less;
        less.width = image.width, less.height = image.height, less.metadata = image.metadata;
        for (const char* written_anyway : {"pixelAspectRatio", "screenWindowWidth"})
            less.metadata.erase(written_anyway);
        for (std::size_t c = 0; c < image.names.size(); ++c) {
            const std::string& name = image.names[c];
            const bool gone = std::any_of(layers.begin(), layers.end(),
                                          [&](const auto& layer) { return name.starts_with(layer + "."); });
            if (!gone) less.add(name, image.channels[c]);
        }
        for (const char* name : {"MotionVector.X", "MotionVector.Y"})
            if (blind) less.add(name, std::vector<float>(std::size_t(width * height), 0.0f));
        mote::core::write_exr(folder.file(fmt::format("{}.{:04}.exr", to, i)), less);
    }
}

}  // namespace

TEST_CASE("motion vectors follow shapes and the camera", "[sequence][motion]") {
    const Folder folder;
    folder.render({"-D", "t=0:0.15:0.3", "-o", "ball.##.exr", "--passes", "2"});
    folder.render({"-D", "c=0:0.1:0.2", "-o", "camera.##.exr", "--passes", "2"});
    CHECK_FALSE(folder.picture("ball.00.exr").find("MotionVector.X"));
    CHECK(folder.picture("ball.00.exr").find("ObjectId.Y"));
    for (const bool camera : {false, true}) {
        const ImageChannels image = folder.picture(camera ? "camera.02.exr" : "ball.02.exr");
        const auto x = plane(image, "MotionVector.X"), y = plane(image, "MotionVector.Y"),
                   id = plane(image, "ObjectId.Y"), cover = plane(image, "Coverage.Y"),
                   px = plane(image, "P.X"), pz = plane(image, "P.Z"), before = plane(image, "PreviousP.X"),
                   material = plane(image, "MaterialId.Y");
        int on_ball = 0, on_wall = 0;
        double worst = 0.0, stays = 0.0;
        for (std::size_t p = 0; p < x.size(); ++p) {
            if (cover[p] < 1.0f) continue;
            const bool of_ball = id[p] == ball;
            // An edge shows both.
            const bool inside =
                p % width > 0 && p % width < width - 1 && id[p - 1] == id[p] && id[p + 1] == id[p];
            if (!inside || id[p - width] != id[p] || id[p + width] != id[p]) continue;
            (of_ball ? on_ball : on_wall) += 1;
            CHECK(material[p] == id[p]);
            const double moved = camera ? 0.1 : of_ball ? -0.15 : 0.0;
            // The mean over a pixel of one over the depth is not that of the mean depth: where it is seen at
            // a slant.
            worst = std::max(worst, std::fabs(x[p] - moved * focal / (distance - pz[p])));
            stays = std::max({stays, double(std::fabs(y[p])),
                              std::fabs(double(px[p]) - before[p] - (camera || !of_ball ? 0.0 : 0.15))});
            if (!camera && !of_ball) CHECK(x[p] == 0.0f);
        }
        CHECK(on_ball > 40);
        CHECK(on_wall > 200);
        CHECK(worst < 0.02);
        CHECK(stays < 1e-5);
    }
}

TEST_CASE("a frame that is made anew has the motion of the frame before it", "[sequence][motion]") {
    const Folder folder;
    const std::vector<std::string> all = {"-D", "t=0:0.15:0.3", "-o", "f.##.exr", "--passes",
                                          "1",  "--resume"};
    folder.render(all);
    const ImageChannels first = folder.picture("f.02.exr");
    const auto written = fs::last_write_time(folder.file("f.01.exr"));
    fs::remove(folder.file("f.02.exr"));
    folder.render(all);
    CHECK(same_bits(folder.picture("f.02.exr"), first));
    CHECK(fs::last_write_time(folder.file("f.01.exr")) == written);
    // With other steps its motion is another one, and in another scene all is.
    std::vector<std::string> further = all;
    further[1] = "t=0:0.3:0.6";
    fs::copy_file(folder.file("f.01.exr"), folder.file("kept.exr"));
    folder.render(further);
    CHECK_FALSE(same_bits(folder.picture("f.01.exr"), folder.picture("kept.exr")));
    const auto again = fs::last_write_time(folder.file("f.01.exr"));
    write_file(folder.file("scene.xml"), read_file(folder.file("scene.xml")) + "<!-- changed -->");
    folder.render(further);
    CHECK(fs::last_write_time(folder.file("f.01.exr")) != again);
}

TEST_CASE("what moves keeps its history and leaves no trail", "[sequence][motion][bmfr]") {
    const Folder folder;
    folder.render({"-D", "t=-0.6:0.15:0.45", "-o", "f.####.exr", "--passes", "1"});
    folder.render({"-D", "t=0.45", "-o", "reference.exr", "--passes", "400", "--seed", "50"});
    strip(folder, "f", "still", {"MotionVector", "PreviousP"});
    strip(folder, "f", "blind", {"MotionVector", "PreviousP", "ObjectId", "P", "N", "Ns", "Albedo", "Depth"},
          true);
    for (const std::string name : {"f", "still", "blind"})
        folder.mote(
            {"denoise", "--method", "bmfr", name + ".####.exr", name + "_d.####.exr", "--quiet", "-t", "1"});
    const auto truth = folder.picture("reference.exr").rgb("");
    std::vector<std::vector<float>> id;
    for (int i = 0; i < 8; ++i)
        id.push_back(plane(folder.picture(fmt::format("f.{:04}.exr", i)), "ObjectId.Y"));
    const auto error_on_ball = [&](const std::string& name) {
        const auto image = folder.picture(name + "_d.0007.exr").rgb("denoised");
        double sum = 0.0, light = 0.0;
        for (std::size_t p = 0; p < image.size(); ++p)
            if (id[7][p] == ball)
                sum += double(glm::dot(image[p] - truth[p], image[p] - truth[p])),
                    light += double(glm::dot(truth[p], truth[p]));
        return std::sqrt(sum / light);
    };
    /// Mean error of the pixels that the ball covered k frames ago for the last time, relative to the ball's
    /// radiance.
    const auto trail = [&](const std::string& name, int k) {
        const auto image = folder.picture(name + "_d.0007.exr").rgb("denoised");
        double sum = 0.0, count = 0.0, light = 0.0, pixels = 0.0;
        for (std::size_t p = 0; p < image.size(); ++p) {
            if (id[7][p] == ball) light += double(truth[p].x), pixels += 1.0;
            bool since = id[std::size_t(7 - k)][p] == ball;
            for (int i = 8 - k; i < 8; ++i) since = since && id[std::size_t(i)][p] != ball;
            if (since) sum += double(image[p].x - truth[p].x), count += 1.0;
        }
        REQUIRE(count > 5.0);
        return std::fabs(sum / count) / (light / pixels);
    };
    // Eight frames have an eighth of the variance of one.
    CHECK(error_on_ball("f") < 0.55 * error_on_ball("still"));
    // Pixels that the ball covered one frame ago: some still show its edge.
    CHECK(trail("f", 1) < 0.2);
    for (int k = 2; k <= 7; ++k) {
        CAPTURE(k);
        CHECK(trail("f", k) < 0.01);
        CHECK(trail("still", k) < 0.01);
        CHECK(trail("blind", k) > 0.2);  // planted: history of what was there before
    }
}
