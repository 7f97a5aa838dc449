// Bounded VPLs plus exact compensation equal volpath in expectation, layer by layer; so does every strategy
// of approximate compensation once its simplifications are switched off: it is then merely another way to
// sample. Every comparison has the power to see an error of a few per cent, and errors that other programs
// make are planted to see that they are found.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "core/formats/xml/scene_loader.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

const std::string exact = R"(<compensation type="exact"/>)";

std::string unbiased_abc(const std::string& strategy) {
    return fmt::format(R"(<compensation type="approximate"><string name="strategy" value="{}"/>
        <integer name="depth" value="-1"/><boolean name="local_visibility" value="true"/>
        <string name="transmittance" value="exact"/></compensation>)",
                       strategy);
}

RenderSpec with_sums(std::uint32_t passes, std::uint64_t seed, bool media) {
    RenderSpec spec{4, passes, seed};
    spec.sums.push_back({"all_indirect", {"indirect_bounded", "compensation_surface"}});
    if (media) spec.sums.push_back({"all_multiple", {"multiple_scattering_bounded", "compensation_volume"}});
    return spec;
}

std::string vpl_integrator(const std::string& compensation, double bound, int paths) {
    return fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>
        <float name="bound" value="{}"/>{}</integrator>)",
                       paths, bound, compensation);
}

/// A scene with its full transport by volpath, to which bounded VPLs with a compensation are compared layer
/// by layer.
class Proof {
  public:
    /// `power`: an error of this fraction is found in every layer.
    Proof(std::unique_ptr<mote::core::Scene> scene, double bound, double power = 0.08,
          std::uint32_t path_passes = 6000)
        : scene_(std::move(scene)),
          bound_(bound),
          power_(power),
          reference_(render_statistics(*scene_, *integrator_from(R"(<integrator type="volpath"/>)"),
                                       {4, path_passes, 32})) {}
    Proof(const std::string& xml, double bound) : Proof(scene_from(xml, 8), bound) {}

    void check(const std::string& compensation, std::uint32_t passes = 450, int paths = 24) const {
        INFO(compensation);
        const bool media = scene_->has_media();
        const auto vpl =
            render_statistics(*scene_, *integrator_from(vpl_integrator(compensation, bound_, paths)),
                              with_sums(passes, 31, media));
        CHECK(vpl.non_finite == 0);
        std::vector<std::pair<std::string, std::string>> layers = {{"all_indirect", "indirect"},
                                                                   {"beauty", "beauty"}};
        if (media) layers.push_back({"all_multiple", "multiple_scattering"});
        for (const auto& [ours, theirs] : layers) {
            check_same_mean(vpl, ours, reference_, theirs);
            if (ours == "beauty") continue;
            CHECK_FALSE(
                same_mean(vpl.scaled(1.0 + power_), ours, reference_, theirs, OnFailure::nothing).passed);
            CHECK_FALSE(
                same_mean(vpl.scaled(1.0 - power_), ours, reference_, theirs, OnFailure::nothing).passed);
        }
        // Without what compensation brings back the sum is wrong: the bound matters in this scene.
        const bool by_media = media && !same_mean(vpl, "multiple_scattering_bounded", reference_,
                                                  "multiple_scattering", OnFailure::nothing)
                                            .passed;
        CHECK((by_media ||
               !same_mean(vpl, "indirect_bounded", reference_, "indirect", OnFailure::nothing).passed));
    }

  private:
    std::unique_ptr<mote::core::Scene> scene_;
    double bound_, power_;
    RenderStatistics reference_;
};

/// A grid of puffs in a file that goes with this object.
class Smoke {
  public:
    Smoke() : xml(smoke_medium(path_)) {}
    ~Smoke() { std::filesystem::remove(path_); }
    Smoke(const Smoke&) = delete;
    Smoke& operator=(const Smoke&) = delete;

  private:
    const std::string path_ =
        (std::filesystem::temp_directory_path() / "mote_compensation_test.vol").string();

  public:
    const std::string xml;
};

/// Smoke by the project's own simulation, in a file that goes with this object.
struct TemporaryGrid {
    explicit TemporaryGrid(const std::string& options) {
        const std::string command =
            "\"" MOTE_BINARY_DIR "/mote_smoke\" " + options + " -o \"" + path + "\" >/dev/null";
        if (std::system(command.c_str()) != 0) throw std::runtime_error("mote_smoke failed");
    }
    ~TemporaryGrid() { std::filesystem::remove(path); }
    TemporaryGrid(const TemporaryGrid&) = delete;
    TemporaryGrid& operator=(const TemporaryGrid&) = delete;
    const std::string path = (std::filesystem::temp_directory_path() / "mote_compensation_test.vdb").string();
};

const std::string forward = R"(<phase type="hg"><float name="g" value="0.7"/></phase>)";

}  // namespace

TEST_CASE("bounded VPLs and exact compensation equal volpath: surfaces", "[compensation][equality]") {
    Proof(box(grey, ""), 4.0).check(exact);
    Proof(box(glossy, ""), 4.0).check(exact);
    Proof(box(mixed, ""), 4.0).check(exact);
}

TEST_CASE("bounded VPLs and exact compensation equal volpath: fog", "[compensation][equality]") {
    const Proof isotropic(box(grey, fog("0.8, 1.0, 1.3", "")), 4.0);
    isotropic.check(exact);
    const Proof forward_scattering(box(grey, fog("0.8, 1.0, 1.3", forward)), 4.0);
    forward_scattering.check(exact);
    // Every simplification off, approximate compensation is another way to sample the same.
    forward_scattering.check(unbiased_abc("1-to-1-homogeneous"));
}

TEST_CASE("bounded VPLs and compensation equal volpath: masks and normal maps",
          "[compensation][equality][mask][normalmap]") {
    Proof(leafy_box(""), 4.0).check(exact);
    const Proof foggy(leafy_box(fog("0.8, 1.0, 1.3", "")), 4.0);
    foggy.check(exact);
    foggy.check(unbiased_abc("1-to-1-homogeneous"));
}

TEST_CASE("bounded VPLs and exact compensation equal volpath: closed box, fog up to the walls",
          "[compensation][equality]") {
    // The camera inside, a lamp under the ceiling, fog that begins where the walls are.
    const std::string xml =
        R"(<scene version="3.0.0">
        <shape type="cube">)" +
        grey + R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.7, 1.0, 1.4"/>
            <rgb name="albedo" value="0.9, 0.8, 0.7"/></medium></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.3"/><rotate x="1" angle="90"/>
            <translate y="0.9"/></transform><emitter type="area"><rgb name="radiance" value="10, 8, 6"/></emitter></shape>
        <sensor type="perspective"><float name="fov" value="70"/><transform name="to_world">
            <lookat origin="0.7, 0.2, 0.8" target="-0.4, -0.3, -0.5" up="0, 1, 0"/></transform></sensor></scene>)";
    const Proof proof(xml, 4.0);
    proof.check(exact);
    proof.check(unbiased_abc("1-to-1-homogeneous"));
}

TEST_CASE("bounded VPLs and every strategy of compensation equal volpath: smoke",
          "[compensation][equality]") {
    const Smoke smoke;
    const Proof proof(box(grey, smoke.xml), 4.0);
    proof.check(exact);
    for (const char* strategy : {"n-to-1", "1-to-1", "1-to-1-homogeneous"})
        proof.check(unbiased_abc(strategy), 250);
}

TEST_CASE("bounded VPLs and exact compensation equal volpath: the smoke room", "[compensation][equality]") {
    const TemporaryGrid grid(
        "--size 24 18 30 --cell 0.163 --steps 40 --haze 0.012 --source 0.7 0.1 0.37 "
        "--source-radius 0.3 --buoyancy 4");
    mote::core::LoadOptions options;
    options.defines = {{"smoke", grid.path}, {"film.width", "8"}, {"film.height", "8"}};
    const Proof proof(mote::core::load_scene(MOTE_SOURCE_DIR "/scenes/smoke_room.xml", registry(), options),
                      4.0, 0.15);
    proof.check(exact);
}

TEST_CASE("compensation that cannot be is refused by name", "[compensation][input]") {
    const auto refused = [](const std::string& inside) -> std::string {
        try {
            integrator_from(R"(<integrator type="mote_vpl">)" + inside + "</integrator>");
        } catch (const mote::core::InputError& error) {
            return error.what();
        }
        return "accepted";
    };
    CHECK_THAT(refused(R"(<compensation type="aproximate"/>)"), ContainsSubstring("approximate"));
    CHECK_THAT(
        refused(
            R"(<compensation type="approximate"><string name="strategy" value="1-to-m"/></compensation>)"),
        ContainsSubstring("1-to-m") && ContainsSubstring("1-to-n"));
    CHECK_THAT(
        refused(R"(<compensation type="approximate"><integer name="depth" value="-2"/></compensation>)"),
        ContainsSubstring("depth"));
    CHECK_THAT(refused(R"(<float name="bound" value="-1"/><compensation type="exact"/>)"),
               ContainsSubstring("no bound"));
    CHECK_THAT(refused(R"(<integer name="eye_samples" value="0"/>)"), ContainsSubstring("eye_samples"));
    for (const char* bound : {"0", "-3"})
        CHECK_THAT(
            refused(fmt::format(R"(<float name="bound" value="{}"/><compensation type="exact"/>)", bound)),
            ContainsSubstring("bound"));
    CHECK_THAT(refused(R"(<float name="bound" value="1e60"/>)"),
               ContainsSubstring("'1e60' is not a finite number"));
    CHECK(refused(R"(<compensation type="none"/>)") == "accepted");
    CHECK(refused(exact) == "accepted");
}

TEST_CASE("compensation that is off costs nothing and changes nothing", "[compensation]") {
    const auto scene = scene_from(box(grey, fog("1, 1, 1", "")), 8);
    const auto render = [&](const std::string& compensation, mote::core::Statistics& statistics) {
        const auto integrator = integrator_from(vpl_integrator(compensation, 4.0, 16));
        const auto estimator = integrator->prepare(*scene, {3, 8, 8, mote::core::SamplerKind::sobol});
        const auto filter = mote::core::make_pixel_filter("box", 0.5f, 0.5f);
        const std::atomic<bool> cancelled{false};
        mote::core::PassImage image(8, 8, integrator->layers(*scene).size());
        estimator->pass({0, *filter, cancelled}, image);
        estimator->add_statistics(statistics);
        return std::vector<mote::core::Rgb>(image.layer(4).begin(), image.layer(4).end());
    };
    mote::core::Statistics without, off, on;
    const auto expected = render("", without), same = render(R"(<compensation type="none"/>)", off);
    CHECK(expected == same);
    CHECK(without.rays == off.rays);
    CHECK(without.values.count("compensation_vertices") + off.values.count("compensation_vertices") == 0);
    // The bounded part is the same bits with compensation, which then costs rays and says so.
    CHECK(render(exact, on) == expected);
    CHECK(on.values["compensation_vertices"] > 0.0);
    CHECK(on.rays["occlusion"] > off.rays["occlusion"]);
}
