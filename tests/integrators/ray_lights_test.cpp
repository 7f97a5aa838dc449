// mote_ray_lights has the mean of volpath, layer by layer: nothing is bounded that is not brought back.
#include <fmt/format.h>

#include <filesystem>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::tests;

namespace {

const std::vector<std::string> all_layers = {"direct", "indirect", "single_scattering", "multiple_scattering",
                                             "beauty"};

struct Effort {
    std::uint32_t passes, path_passes;
    double planted;  ///< the error that is to be seen
};

RenderStatistics ray_lights(const mote::core::Scene& scene, const std::string& settings, std::uint32_t passes,
                            std::uint64_t seed = 31) {
    return render_statistics(
        scene, *integrator_from(R"(<integrator type="mote_ray_lights">)" + settings + "</integrator>"),
        {4, passes, seed});
}

void check(const std::string& xml, const std::string& settings, const std::string& path_settings,
           const Effort& effort, const std::vector<std::string>& layers = all_layers) {
    const auto scene = scene_from(xml, 8);
    const auto lights = ray_lights(*scene, settings, effort.passes);
    const auto reference = render_statistics(
        *scene, *integrator_from(R"(<integrator type="volpath">)" + path_settings + "</integrator>"),
        {4, effort.path_passes, 32});
    CHECK(lights.non_finite == 0);
    for (const std::string& layer : layers) {
        check_same_mean(lights, layer, reference, layer, {1.0 + effort.planted, 1.0 - effort.planted});
    }
}

const std::string paths = R"(<integer name="paths" value="8"/>)";
// Lights are sampled by power, then by what they would send.
const std::string shared = R"(<integer name="paths" value="40"/><integer name="candidates" value="12"/>
                              <integer name="connections" value="6"/>)";
const std::string forward = R"(<phase type="hg"><float name="g" value="0.6"/></phase>)";
const Effort quick{200, 2000, 0.15}, long_run{3000, 30000, 0.1};

void check_all(const Effort& effort) {
    const mote::tests::TemporaryFolder folder;
    const std::string smoke = smoke_medium(folder.file("smoke.vol"));
    check(box(grey, fog("0.8, 1.0, 1.3", "")), paths, "", effort);
    check(box(mixed, fog("0.8, 1.0, 1.3", forward)), paths, "", effort);
    check(box(grey, smoke), paths, "", effort);
    check(box(grey, fog("0.8, 1.0, 1.3", "")), shared, "", effort);
    check(box(mixed, fog("0.8, 1.0, 1.3", forward)), shared, "", effort);
}

}  // namespace

TEST_CASE("ray lights equal paths in fog", "[ray_lights][equality]") {
    check(box(grey, fog("0.8, 1.0, 1.3", "")), paths, "", quick);
}
TEST_CASE("ray lights equal paths where all lights are connected to", "[ray_lights][equality]") {
    check(box(grey, fog("0.8, 1.0, 1.3", "")),
          R"(<integer name="paths" value="4"/><integer name="connections" value="0"/>)", "", quick);
}
TEST_CASE("ray lights equal paths in smoke, a subset of them", "[ray_lights][equality]") {
    const mote::tests::TemporaryFolder folder;
    check(box(grey, smoke_medium(folder.file("smoke.vol"))), shared, "", quick);
}
TEST_CASE("ray lights equal paths: every kind of medium, with fine eyes", "[.][ray_lights_long]") {
    check_all(long_run);
}
TEST_CASE("ray lights equal paths: max_depth, thick fog, fog without walls, panes", "[.][ray_lights_long]") {
    for (const int depth : {3, 4}) {
        const std::string limit = fmt::format(R"(<integer name="max_depth" value="{}"/>)", depth);
        check(box(grey, fog("0.8, 1.0, 1.3", "")), paths + limit, limit, long_run);
    }
    // Far noisier than thin fog, and with tails so long that the spread of 3000 passes shows too little of
    // them.
    check(box(grey, fog("6, 8, 10", forward)), paths, "", {30000, 60000, 0.25});
    check(leafy_box(fog("0.8, 1.0, 1.3", "")), paths + R"(<integer name="max_depth" value="5"/>)",
          R"(<integer name="max_depth" value="5"/>)", long_run);
    // Without end: rays that meet nothing. Tails are long here too.
    check(
        R"(<scene version="3.0.0"><medium type="homogeneous" id="air"><rgb name="sigma_t" value="0.4, 0.3, 0.2"/>
        <rgb name="albedo" value="0.9, 0.8, 0.7"/></medium>
        <shape type="sphere"><float name="radius" value="0.5"/><bsdf type="diffuse"/><ref name="exterior" id="air"/></shape>
        <emitter type="point"><point name="position" x="1" y="1" z="1"/></emitter>
        <sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
        <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform><ref id="air"/></sensor></scene>)",
        paths, "", {60000, 60000, 0.1}, {"direct", "single_scattering", "multiple_scattering", "beauty"});
}

TEST_CASE("ray lights: nothing to do, and what max_depth leaves", "[ray_lights][extremes]") {
    const auto scene = scene_from(box(grey, fog("1", "")), 8);
    const auto none = ray_lights(*scene, R"(<integer name="paths" value="0"/>)", 2);
    CHECK(none.whole[none.layer("multiple_scattering")][0].mean == 0.0);
    CHECK(none.whole[none.layer("direct")][0].mean > 0.0);
    const auto two = ray_lights(*scene, R"(<integer name="max_depth" value="2"/>)", 4);
    CHECK(two.whole[two.layer("single_scattering")][0].mean > 0.0);
    CHECK(two.whole[two.layer("multiple_scattering")][0].mean == 0.0);
    CHECK(two.whole[two.layer("indirect")][0].mean == 0.0);
    // Without media it is VPLs with their compensation.
    const auto bare = ray_lights(*scene_from(box(grey, ""), 8), paths, 20);
    CHECK(bare.non_finite == 0);
    CHECK(bare.whole[bare.layer("indirect")][0].mean > 0.0);
    // A medium that scatters nothing, and one with nothing in it.
    for (const char* sigma_t : {"0", "1"}) {
        auto medium = fog(sigma_t, "");
        medium.replace(medium.find("0.9, 0.8, 0.7"), 13, "0");
        const auto r = ray_lights(*scene_from(box(grey, medium), 8), paths, 4);
        CHECK(r.non_finite == 0);
        CHECK(r.whole[r.layer("multiple_scattering")][0].mean == 0.0);
    }
    CHECK_THROWS_WITH(
        integrator_from(
            R"(<integrator type="mote_ray_lights"><float name="bound" value="-1"/></integrator>)"),
        ContainsSubstring("bound"));
}
