// mote_bdpt has the mean of the path tracers, layer by layer; each of its techniques alone has the mean of
// every other; and light that nothing absorbs fills a furnace evenly.
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string bdpt(const std::string& parameters = "") {
    return R"(<integrator type="mote_bdpt">)" + parameters + "</integrator>";
}

/// Every layer, and the beauty, against a path tracer.
void check_equal(const std::string& xml, const std::string& reference, const std::string& parameters = "",
                 std::uint32_t passes = 250, std::uint32_t reference_passes = 500) {
    const auto scene = scene_from(xml, 16);
    const auto ours = render_statistics(*scene, *integrator_from(bdpt(parameters)), {8, passes, 1});
    const auto truth = render_statistics(
        *scene, *integrator_from("<integrator type=\"" + reference + "\">" + parameters + "</integrator>"),
        {8, reference_passes, 2});
    CHECK(ours.non_finite == 0);
    for (const std::string& layer : truth.layers) {
        check_same_mean(ours, layer, truth, layer);
    }
    CHECK_FALSE(same_mean(ours.scaled(1.06), "beauty", truth, "beauty", OnFailure::nothing).passed);
}

const std::string balls = R"(
    <shape type="sphere"><point name="center" x="-0.35" y="-0.4" z="0.2"/><float name="radius" value="0.35"/>
        <bsdf type="roughdielectric"><float name="alpha" value="0.4"/></bsdf></shape>
    <shape type="sphere"><point name="center" x="0.5" y="0.2" z="-0.4"/><float name="radius" value="0.3"/>
        <bsdf type="conductor"/></shape>
    <shape type="sphere"><point name="center" x="-0.4" y="0.45" z="-0.3"/><float name="radius" value="0.2"/>
        <bsdf type="plastic"/></shape>)";
const std::string lamps = R"(
    <emitter type="point"><point name="position" x="-0.5" y="0.1" z="0.6"/><rgb name="intensity" value="0.3"/></emitter>
    <emitter type="directional"><vector name="direction" x="-0.2" y="-0.5" z="-1"/><rgb name="irradiance" value="0.4"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.2, 0.3, 0.4"/></emitter>)";

}  // namespace

TEST_CASE("bidirectional paths have the mean of path", "[bdpt][equality]") {
    SECTION("diffuse walls") { check_equal(box(grey, ""), "path"); }
    SECTION("balls of rough glass, metal and plastic, four kinds of light") {
        check_equal(with(box(mixed, ""), balls + lamps), "path");
    }
    SECTION("holes, bent normals") { check_equal(leafy_box(""), "path"); }
    SECTION("paths of at most three edges") {
        check_equal(box(grey, ""), "path", R"(<integer name="max_depth" value="3"/>)");
    }
    SECTION("lights that eye rays pass") {
        check_equal(with(box(grey, ""), lamps), "path", R"(<boolean name="hide_emitters" value="true"/>)");
    }
}

TEST_CASE("bidirectional paths have the mean of path with a lens and with parallel rays",
          "[bdpt][equality]") {
    const std::string look = R"(<lookat origin="0.2, 0.1, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform>
        <float name="near_clip" value="1.5"/></sensor>)";
    check_equal(with_sensor(box(grey, ""), R"(<sensor type="thinlens"><float name="fov" value="34"/>
        <float name="aperture_radius" value="0.15"/><float name="focus_distance" value="3"/><transform name="to_world">)" +
                                               look),
                "path");
    check_equal(
        with_sensor(
            box(grey, ""),
            R"(<sensor type="orthographic"><transform name="to_world"><scale x="0.9" y="0.9"/>)" + look),
        "path");
}

TEST_CASE("bidirectional paths have the mean of volpath", "[bdpt][equality]") {
    SECTION("coloured fog that scatters forward") {
        const std::string phase = R"(<phase type="hg"><float name="g" value="0.6"/></phase>)";
        check_equal(box(mixed, fog("0.6, 0.9, 1.2", phase)), "volpath", "", 250, 1000);
    }
    SECTION("smoke") {
        TemporaryFolder folder;
        check_equal(box(grey, smoke_medium(folder.file("smoke.vol"))), "volpath");
    }
    SECTION("a ball of rough glass with fog inside") {  // connections pass its boundary
        const std::string ball =
            R"(<shape type="sphere"><point name="center" x="0.1" y="0" z="0.3"/><float name="radius" value="0.5"/>
            <bsdf type="roughdielectric"><float name="alpha" value="0.5"/></bsdf>)" +
            fog("3, 4, 5", R"(<phase type="hg"><float name="g" value="0.6"/></phase>)") + "</shape>";
        check_equal(with(box(grey, ""), ball), "volpath", "", 250, 1000);
    }
    SECTION("smoke with holes in what is around it, and the sky") {
        TemporaryFolder folder;
        check_equal(with(leafy_box(smoke_medium(folder.file("smoke.vol"))), lamps), "volpath");
    }
}

TEST_CASE("every technique alone has the same mean", "[bdpt][strategies]") {
    // A wall, a floor and a lamp behind the eye that stay apart: no pair of vertices has a great G.
    const std::string xml = R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="2"/><translate z="-2"/></transform>)" +
                            grey + R"(</shape>
        <shape type="rectangle"><transform name="to_world"><scale value="1"/><rotate y="1" angle="180"/>
            <translate x="-0.5" z="4.5"/></transform><emitter type="area"><rgb name="radiance" value="4"/></emitter>)" +
                            grey + R"(</shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale x="2" z="2"/>
            <translate y="-1.8" z="1"/></transform>)" +
                            grey + R"(</shape>
        <sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
            <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    const auto scene = scene_from(xml, 8);
    const std::string parameters =
        R"(<string name="heuristic" value="none"/><integer name="strategies" value="4"/>
        <integer name="max_depth" value="4"/><boolean name="all_connections" value="true"/>)";
    const auto a = render_statistics(*scene, *integrator_from(bdpt(parameters)), {8, 6000, 1});
    const auto b = render_statistics(*scene, *integrator_from(bdpt(parameters)), {8, 6000, 2});
    for (int edges = 2; edges <= 4; ++edges) {
        const std::string nee = fmt::format("s1_t{}", edges);
        for (int s = 0; s <= edges; ++s) {
            const std::string technique = fmt::format("s{}_t{}", s, edges + 1 - s);
            check_same_mean(a, technique, b, nee);
        }
        CHECK_FALSE(same_mean(a.scaled(edges == 2 ? 1.02 : 1.1), nee, b, nee, OnFailure::nothing).passed);
    }
}

TEST_CASE("nothing is lost in a furnace", "[bdpt][furnace]") {
    TemporaryFolder folder;
    std::string smoke = smoke_medium(folder.file("smoke.vol"));
    smoke.replace(smoke.find("0.9, 0.8, 0.7"), 13, "1, 1, 1");
    for (const std::string& medium :
         {std::string(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.5, 2, 8"/>
              <rgb name="albedo" value="1"/></medium>)"),
          smoke}) {
        const std::string xml = R"(<scene version="3.0.0"><shape type="cube"><transform name="to_world">
            <scale value="0.9"/></transform><bsdf type="null"/>)" +
                                medium +
                                R"(</shape><emitter type="constant"><rgb name="radiance" value="1"/></emitter>
            <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
            <lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
        const auto scene = scene_from(xml, 8);
        for (const char* heuristic : {"power", "balance"}) {
            const auto r = render_statistics(
                *scene,
                *integrator_from(bdpt(fmt::format(R"(<string name="heuristic" value="{}"/>)", heuristic))),
                {4, 400, 3});
            CHECK(r.non_finite == 0);
            INFO(heuristic);
            check_mean_is(r, "beauty", 1.0, {1.05});
        }
    }
}
