// Bounded VPLs plus exact compensation equal volpath in expectation, layer by layer; so does every strategy
// of approximate compensation once its simplifications are switched off: it is then merely another way to
// sample. Every comparison has the power to see an error of a few per cent, and errors that other programs
// make are planted to see that they are found.
#include <fmt/format.h>

#include <filesystem>

#include "core/scene/error.h"
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

struct Effort {
    std::uint32_t vpl_passes = 1500, path_passes = 12000;
    int paths = 24;
};

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

/// Full transport, layer by layer, by volpath and by bounded VPLs with `compensation`.
void check_full_transport(const std::string& xml, bool media, double bound, const std::string& compensation,
                          Effort effort = {}) {
    const auto scene = scene_from(xml, 8);
    const auto vpl =
        render_statistics(*scene, *integrator_from(vpl_integrator(compensation, bound, effort.paths)),
                          with_sums(effort.vpl_passes, 31, media));
    const auto reference = render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"),
                                             {4, effort.path_passes, 32});
    std::vector<std::pair<std::string, std::string>> layers = {{"all_indirect", "indirect"},
                                                               {"beauty", "beauty"}};
    if (media) layers.push_back({"all_multiple", "multiple_scattering"});
    CHECK(vpl.non_finite == 0);
    for (const auto& [ours, theirs] : layers) {
        const ZTest test = same_mean(vpl, ours, reference, theirs);
        INFO(test.report);
        CHECK(test.passed);
        // Errors of 5 % up or down are found.
        CHECK_FALSE(same_mean(vpl.scaled(1.05), ours, reference, theirs, OnFailure::nothing).passed);
        CHECK_FALSE(same_mean(vpl.scaled(0.95), ours, reference, theirs, OnFailure::nothing).passed);
    }
    // Without what compensation brings back the sum is wrong: the bound matters in this scene.
    CHECK_FALSE(same_mean(vpl, "indirect_bounded", reference, "indirect", OnFailure::nothing).passed);
}

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

const std::string forward = R"(<phase type="hg"><float name="g" value="0.7"/></phase>)";

}  // namespace

TEST_CASE("bounded VPLs and exact compensation equal volpath: diffuse", "[compensation][equality]") {
    check_full_transport(box(grey, ""), false, 4.0, exact);
}
TEST_CASE("bounded VPLs and exact compensation equal volpath: glossy", "[compensation][equality]") {
    check_full_transport(box(glossy, ""), false, 4.0, exact);
}
TEST_CASE("bounded VPLs and exact compensation equal volpath: homogeneous fog", "[compensation][equality]") {
    check_full_transport(box(grey, fog("0.8, 1.0, 1.3", "")), true, 4.0, exact);
}
TEST_CASE("bounded VPLs and exact compensation equal volpath: forward scattering",
          "[compensation][equality]") {
    check_full_transport(box(grey, fog("0.8, 1.0, 1.3", forward)), true, 4.0, exact);
}
TEST_CASE("bounded VPLs and exact compensation equal volpath: smoke", "[compensation][equality]") {
    const Smoke smoke;
    check_full_transport(box(grey, smoke.xml), true, 4.0, exact);
}

TEST_CASE("approximate compensation without simplifications equals volpath: smoke",
          "[compensation][equality]") {
    const Smoke smoke;
    for (const char* strategy : {"n-to-1", "1-to-1", "1-to-1-homogeneous"}) {
        INFO(strategy);
        check_full_transport(box(grey, smoke.xml), true, 4.0, unbiased_abc(strategy));
    }
}
TEST_CASE("approximate compensation without simplifications equals volpath: fog",
          "[compensation][equality]") {
    check_full_transport(box(grey, fog("0.8, 1.0, 1.3", forward)), true, 4.0,
                         unbiased_abc("1-to-1-homogeneous"));
}
