// The first picture of a long render, at half the resolution.
#include "session/coarse_preview.h"

#include "tests/support/catch.h"

using namespace mote;
using session::LoadedScene, session::RenderSettings;

namespace {

LoadedScene scene_of(int width, int height, const std::string& integrator = "path") {
    return LoadedScene::from_text(R"(<scene version="3.0.0"><integrator type=")" + integrator + R"("/>
        <sensor type="perspective"><film type="hdrfilm"><integer name="width" value=")" +
                                      std::to_string(width) + R"("/><integer name="height" value=")" +
                                      std::to_string(height) + R"("/><rfilter type="box"/></film><transform
        name="to_world"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="sphere"><bsdf type="diffuse"/></shape><emitter type="constant"/></scene>)",
                                  "");
}

RenderSettings limit_of(double seconds) {
    RenderSettings settings;
    settings.stop.seconds = seconds, settings.threads = 2;
    return settings;
}

struct Cancelling : session::RenderObserver {
    bool cancelled() override { return true; }
};

}  // namespace

TEST_CASE("A picture at half the resolution is worth its time in long renders of large films",
          "[session][preview]") {
    using session::coarse_preview_pays;
    const LoadedScene large = scene_of(960, 600);
    CHECK(coarse_preview_pays(large, limit_of(57.0)));
    CHECK_FALSE(coarse_preview_pays(large, limit_of(10.0)));
    CHECK_FALSE(coarse_preview_pays(scene_of(480, 300), limit_of(57.0)));
    RenderSettings settings = limit_of(57.0);
    settings.stop.seconds.reset(), settings.stop.passes = 100;
    CHECK_FALSE(coarse_preview_pays(large, settings));  // their time is not given
    settings = limit_of(57.0), settings.resume = true;
    CHECK_FALSE(coarse_preview_pays(large, settings));
}

TEST_CASE("A coarse preview is one pass at half the resolution, at the size of the film",
          "[session][preview]") {
    session::RenderObserver silent;
    const LoadedScene scene = scene_of(61, 40);
    const auto image = session::coarse_preview(scene, limit_of(600.0), silent);
    REQUIRE(image);
    CHECK(image->width == 61);
    CHECK(image->height == 40);
    RenderSettings one = limit_of(600.0);
    one.stop = {}, one.stop.passes = 1;
    const core::ImageChannels half = session::render(scene_of(31, 20), one).image;
    CHECK(image->rgb("") == session::enlarged(half, 61, 40).rgb(""));
    // The film of the render itself is as it was.
    CHECK(scene.scene().film().width == 61);
}

TEST_CASE("A coarse preview that is cancelled shows nothing", "[session][preview]") {
    Cancelling cancelling;
    CHECK_FALSE(session::coarse_preview(scene_of(3000, 2000, "volpath"), limit_of(600.0), cancelling));
}

TEST_CASE("An enlarged picture has the light of pixels at their centres", "[session][preview]") {
    core::ImageChannels small;
    small.width = 4, small.height = 3;
    std::vector<core::Rgb> ramp;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 4; ++i) ramp.emplace_back(float(i) + 0.5f, 2.0f * (float(j) + 0.5f), 1.0f);
    small.add_rgb("", ramp);
    const std::vector<core::Rgb> large = session::enlarged(small, 8, 6).rgb("");
    for (int j = 0; j < 6; ++j)
        for (int i = 0; i < 8; ++i) {
            const core::Rgb& c = large[std::size_t(j * 8 + i)];
            // Linear inside of the outermost centres, constant beyond.
            CHECK(c.x == Approx(std::clamp(0.5 * (i + 0.5), 0.5, 3.5)));
            CHECK(c.y == Approx(std::clamp(1.0 * (j + 0.5), 1.0, 5.0)));
            CHECK(c.z == 1.0f);
        }
    CHECK(session::enlarged(small, 4, 3).rgb("") == ramp);
}
