// mote render --auxiliary: features beside a picture that stays as it is, and surfaces at pixel centres.
#include "core/formats/pictures/image_file.h"
#include "tests/apps/run_mote.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using mote::core::ImageChannels, mote::core::read_exr;

namespace {

const char* const scene = R"(<scene version="3.0.0"><integrator type="path"/>
    <shape type="sphere"><bsdf type="plastic"/></shape><emitter type="constant"/>
    <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="15"/><integer name="height" value="15"/></film></sensor></scene>)";

ImageChannels rendered(const TemporaryFolder& folder, const std::string& name,
                       std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "scene.xml", "-o", name, "--quiet"});
    const RunResult run = run_mote(folder, more);
    INFO(run.out << run.err);
    REQUIRE(run.exit_code == 0);
    return read_exr(folder.file(name));
}

}  // namespace

TEST_CASE("--auxiliary adds features and leaves the picture as it is", "[command][auxiliary]") {
    const TemporaryFolder folder;
    write_file(folder.file("scene.xml"), scene);
    const ImageChannels plain = rendered(folder, "plain.exr", {"--passes", "8"});
    const ImageChannels with = rendered(folder, "with.exr", {"--passes", "8", "--auxiliary"});
    for (const std::string& name : plain.names) {
        INFO(name);
        REQUIRE(with.find(name));
        CHECK(*with.find(name) == *plain.find(name));
    }
    const std::vector<std::string> features = {"P.X",     "N.Y",      "Ns.Z",
                                               "Depth.Z", "Albedo.R", "DiffuseAlbedo.G"};
    for (const std::string& name : features) {
        INFO(name);
        CHECK_FALSE(plain.find(name));
        CHECK(with.find(name));
        CHECK(with.find("Variance." + name));
    }
    CHECK(with.find("Coverage.Y"));
    CHECK_FALSE(with.find("Transmittance.R"));  // no media
    constexpr std::size_t middle = 7 * 15 + 7, corner = 0;
    CHECK((*with.find("Center.P.Z"))[middle] == Approx(1.0).epsilon(1e-5));
    CHECK((*with.find("Center.N.Z"))[middle] == Approx(1.0).epsilon(1e-5));
    // A mean over the pixel's filter lies behind the nearest point.
    CHECK((*with.find("P.Z"))[middle] < 1.0f);
    CHECK((*with.find("P.Z"))[middle] > 0.97f);
    CHECK((*with.find("Depth.Z"))[middle] == Approx(5.0f - (*with.find("P.Z"))[middle]).epsilon(1e-2));
    CHECK((*with.find("Coverage.Y"))[middle] == 1.0f);
    CHECK((*with.find("Coverage.Y"))[corner] == 0.0f);
    CHECK(std::isinf((*with.find("Depth.Z"))[corner]));
    // The base of a plastic is less than all of it.
    const auto share = [&](const char* name) { return (*with.find(name))[middle]; };
    CHECK(share("DiffuseAlbedo.R") > 0.1f);
    CHECK(share("DiffuseAlbedo.R") < share("Albedo.R"));
    CHECK(share("DiffuseAlbedo.R") == Approx(share("Center.DiffuseAlbedo.R")).epsilon(0.01));

    const ImageChannels once = rendered(folder, "once.exr", {"--passes", "1", "--auxiliary"});
    CHECK(once.find("P.X"));
    CHECK_FALSE(once.find("Variance.P.X"));
}
