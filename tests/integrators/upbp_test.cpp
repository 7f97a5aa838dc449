// mote_upbp has the mean of the path tracers, layer by layer, with all techniques and with merges alone; and
// light that nothing absorbs fills a furnace evenly. Kernels are so small here that their bias is far below
// the noise.
#include <fmt/format.h>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

const std::string merges_alone = R"(<boolean name="bpt" value="false"/>)";
std::string without(const std::string& technique) {
    return R"(<boolean name=")" + technique + R"(" value="false"/>)";
}
const std::string beams_alone = merges_alone + without("pp3d") + without("bb1d");
const std::string points_alone = merges_alone + without("pb2d") + without("bb1d");
/// At full efforts: with lower ones noise hides planted errors.
std::string crossings_alone(const std::string& light, const std::string& query) {
    return merges_alone + without("pp3d") + without("pb2d") +
           fmt::format(R"(<string name="efforts" value="equal"/>
           <string name="light_beams" value="{}"/><string name="query_beams" value="{}"/>)",
                       light, query);
}

std::string upbp(const std::string& parameters) {
    return R"(<integrator type="mote_upbp">)" + parameters + "</integrator>";
}

/// Merges alone are so few in a block that their mean is far from normal: there the image is one block.
constexpr int whole_image = 16;

const std::vector<std::string> in_media = {"indirect", "multiple_scattering"};

/// Every layer against a path tracer, and the same test against `wrong` layers of ours times `planted`.
void check_equal(const std::string& xml, const std::string& reference, const std::string& parameters,
                 double planted, int block = 8, const std::vector<std::string>& wrong = {"indirect"}) {
    constexpr std::uint32_t passes = 400;
    const auto scene = scene_from(xml, 16);
    const auto ours = render_statistics(*scene, *integrator_from(upbp(parameters)), {block, passes, 1});
    const auto truth = render_statistics(*scene, *integrator_from("<integrator type=\"" + reference + "\"/>"),
                                         {block, 6 * passes, 2});
    CHECK(ours.non_finite == 0);
    for (const std::string& layer : truth.layers) check_same_mean(ours, layer, truth, layer);
    for (const std::string& layer : wrong) {
        INFO("planted in " << layer);
        CHECK_FALSE(same_mean(ours.scaled(planted), layer, truth, layer, OnFailure::nothing).passed);
    }
}

std::string forward(double g) {
    return fmt::format(R"(<phase type="hg"><float name="g" value="{}"/></phase>)", g);
}

}  // namespace

TEST_CASE("points, beams and paths have the mean of path", "[upbp][equality]") {
    SECTION("all techniques") { check_equal(box(grey, ""), "path", "", 1.06); }
    SECTION("power heuristic") {
        check_equal(box(mixed, ""), "path", R"(<string name="heuristic" value="power"/>)", 1.06);
    }
    SECTION("surface photons alone") { check_equal(box(grey, ""), "path", merges_alone, 1.25, whole_image); }
    SECTION("holes, bent normals") { check_equal(leafy_box(""), "path", "", 1.1); }
}

TEST_CASE("points, beams and paths have the mean of volpath", "[upbp][equality]") {
    SECTION("coloured fog, all techniques") {
        for (const double g : {-0.8, 0.0, 0.8})
            check_equal(box(grey, fog("0.6, 0.9, 1.2", forward(g))), "volpath", "", 1.1, 8, in_media);
    }
    SECTION("coloured fog, beams alone") {
        for (const double g : {-0.8, 0.8})
            check_equal(box(grey, fog("0.6, 0.9, 1.2", forward(g))), "volpath", beams_alone, 1.3, whole_image,
                        in_media);
    }
    SECTION("coloured fog, points alone") {
        check_equal(box(grey, fog("0.6, 0.9, 1.2", forward(0.6))), "volpath", points_alone, 1.3, whole_image);
    }
    SECTION("coloured fog, crossing beams alone") {
        const auto check = [](double g, const char* light, const char* query) {
            INFO(light << " beams of lights, " << query << " query beams, g = " << g);
            check_equal(box(grey, fog("0.6, 0.9, 1.2", forward(g))), "volpath", crossings_alone(light, query),
                        1.3, whole_image, in_media);
        };
        check(-0.8, "short", "long"), check(0.0, "short", "short");
        check(0.0, "long", "long"), check(0.8, "long", "short");
    }
    SECTION("grey fog, crossing beams alone") {
        check_equal(box(grey, fog("0.9", forward(0.6))), "volpath", crossings_alone("short", "long"), 1.3,
                    whole_image, in_media);
    }
    SECTION("coloured fog, short query beams") {
        check_equal(box(grey, fog("0.6, 0.9, 1.2", forward(0.8))), "volpath",
                    beams_alone + R"(<string name="query_beams" value="short"/>)", 1.3, whole_image,
                    in_media);
    }
    SECTION("a tinted pane in coloured fog") {
        std::string xml = box(grey, fog("0.6, 0.9, 1.2", forward(0.3)));
        xml.insert(xml.find("<sensor"), R"(<shape type="rectangle"><transform name="to_world">
            <scale x="0.7" y="0.5"/><rotate x="1" angle="-80"/><translate y="0.1"/></transform>
            <bsdf type="thindielectric"><rgb name="specular_transmittance" value="0.9, 0.6, 0.3"/>
            <rgb name="specular_reflectance" value="0"/></bsdf></shape>)");
        check_equal(xml, "volpath", "", 1.1, 8, in_media);
        check_equal(xml, "volpath", crossings_alone("short", "long"), 1.3, whole_image, in_media);
        check_equal(xml, "volpath", crossings_alone("long", "short"), 1.3, whole_image, in_media);
    }
    SECTION("smoke, crossing beams alone") {
        TemporaryFolder folder;
        const std::string smoke = box(grey, smoke_medium(folder.file("smoke.vol")));
        check_equal(smoke, "volpath", crossings_alone("short", "long"), 1.3, whole_image, in_media);
        check_equal(smoke, "volpath", crossings_alone("long", "short"), 1.3, whole_image, in_media);
    }
    SECTION("smoke") {
        TemporaryFolder folder;
        const std::string smoke = box(grey, smoke_medium(folder.file("smoke.vol")));
        check_equal(smoke, "volpath", "", 1.1, 8, in_media);
        check_equal(smoke, "volpath", beams_alone, 1.3, whole_image, in_media);
        check_equal(smoke, "volpath", merges_alone, 1.3, whole_image);
    }
}

TEST_CASE("nothing is lost in a furnace of points, beams and paths", "[upbp][furnace]") {
    const std::string xml = R"(<scene version="3.0.0"><shape type="cube"><transform name="to_world">
        <scale value="0.9"/></transform><bsdf type="null"/><medium type="homogeneous" name="interior">
        <rgb name="sigma_t" value="0.5, 2, 8"/><rgb name="albedo" value="1"/></medium></shape>
        <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
        <sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
        <lookat origin="0, 0, 3.6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    for (const char* heuristic : {"power", "balance"}) {
        INFO(heuristic);
        const auto r = render_statistics(
            *scene_from(xml, 8),
            *integrator_from(upbp(fmt::format(R"(<string name="heuristic" value="{}"/>)", heuristic))),
            {4, 400, 3});
        CHECK(r.non_finite == 0);
        check_mean_is(r, "beauty", 1.0, {1.05});
    }
}

TEST_CASE("kernels without a size, or larger than the scene, leave finite light", "[upbp][extremes]") {
    const std::string dense = box(grey, fog("1e4", "")), thin = box(grey, fog("1e-6", ""));
    for (const std::string& xml : {dense, thin})
        for (const char* radius : {"0", "100"}) {
            INFO(radius);
            const auto r = render_statistics(
                *scene_from(xml, 4),
                *integrator_from(upbp(fmt::format(
                    R"(<float name="radius" value="{}"/><integer name="max_depth" value="8"/>)", radius))),
                {4, 4, 3});
            CHECK(r.non_finite == 0);
        }
    SECTION("without a size it is bidirectional path tracing") {
        check_equal(box(grey, fog("0.6, 0.9, 1.2", "")), "volpath", R"(<float name="radius" value="0"/>)",
                    1.1);
    }
}

TEST_CASE("one light path or none, and beams parallel to all rays, are no exception", "[upbp][extremes]") {
    const auto finite = [](const std::string& xml, int size, const std::string& parameters) {
        const auto r =
            render_statistics(*scene_from(xml, size), *integrator_from(upbp(parameters)), {size, 16, 3});
        CHECK(r.non_finite == 0);
    };
    const std::string foggy = box(grey, fog("0.9", ""));
    finite(foggy, 1, ""), finite(foggy, 1, crossings_alone("long", "long"));
    // A lamp outside that shines away from all: light paths without a vertex.
    std::string dark = foggy;
    const std::string place = R"(<translate y="0.95"/>)";
    dark.replace(dark.find(place), place.size(), R"(<rotate x="1" angle="180"/><translate y="9"/>)");
    finite(dark, 4, "");
    // Light along the rays of the camera: no two beams cross before the light has scattered.
    const std::string parallel =
        R"(<scene version="3.0.0"><shape type="cube"><bsdf type="null"/>)" + fog("0.9", forward(0.3)) +
        R"(</shape><emitter type="directional"><vector name="direction" x="0" y="0" z="-1"/>
        <rgb name="irradiance" value="3, 2, 1"/></emitter><sensor type="orthographic"><transform name="to_world">
        <scale x="0.7" y="0.7"/><lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    finite(parallel, 4, crossings_alone("short", "long"));
    check_equal(parallel, "volpath", "", 1.1, 8, {"single_scattering"});
}
