// mote_vpl is proved, not eyeballed: bounded, it must equal volpath with every path weighted by min(G*, b)/G*
// at the edge where a VPL connects, layer by layer; unbounded, volpath itself, where VPLs cannot come near
// receivers.
#include <fmt/format.h>

#include <filesystem>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

void check_layers(const std::string& xml, const std::string& reference_settings,
                  const std::string& vpl_settings, const std::vector<std::string>& layers,
                  std::uint32_t vpl_passes = 3000, std::uint32_t path_passes = 16000, int paths = 24) {
    const auto scene = scene_from(xml, 8);
    const auto vpl = render_statistics(
        *scene,
        *integrator_from(
            fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>)", paths) +
            vpl_settings + "</integrator>"),
        {4, vpl_passes, 21});
    const auto reference = render_statistics(
        *scene, *integrator_from(R"(<integrator type="volpath">)" + reference_settings + "</integrator>"),
        {4, path_passes, 22});
    for (const std::string& layer : layers) {
        // The test has the power to see an error of 4 % in the layer, up or down.
        check_same_mean(vpl, layer, reference, layer, {1.04, 0.96});
    }
}

void check_bounded(const std::string& xml, bool media, double bound, int paths = 24) {
    std::vector<std::string> layers = {"direct", "indirect_bounded", "beauty"};
    if (media) layers.insert(layers.end(), {"single_scattering", "multiple_scattering_bounded"});
    const auto setting = [&](const char* name) {
        return fmt::format(R"(<float name="{}" value="{}"/>)", name, bound);
    };
    // In fog it is the paths that are noisy, and the VPLs that take the time.
    check_layers(xml, setting("vpl_bound"), setting("bound"), layers, media ? 1500 : 3000, 16000, paths);
}

/// A sphere of 12 x 6 quads with smooth normals, as OBJ text: coarse, so that shading and geometric normals
/// differ.
std::string coarse_sphere() {
    std::string obj;
    const int columns = 12, rows = 6;
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const double theta = std::acos(-1.0) * r / rows, phi = 2.0 * std::acos(-1.0) * c / columns;
            const double x = std::sin(theta) * std::cos(phi), y = std::cos(theta),
                         z = std::sin(theta) * std::sin(phi);
            obj += fmt::format("v {0} {1} {2}\nvn {0} {1} {2}\n", x, y, z);
        }
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int a = r * columns + c + 1, b = r * columns + (c + 1) % columns + 1;
            obj += fmt::format("f {0}//{0} {1}//{1} {2}//{2} {3}//{3}\n", a, b, b + columns, a + columns);
        }
    return obj;
}

}  // namespace

TEST_CASE("bounded VPLs equal bounded paths: diffuse", "[vpl][equality]") {
    check_bounded(box(grey, ""), false, 4.0);
}
TEST_CASE("bounded VPLs equal bounded paths: max_depth counts the whole path", "[vpl][equality]") {
    const std::string three = R"(<integer name="max_depth" value="3"/>)";
    check_layers(box(grey, ""), three + R"(<float name="vpl_bound" value="4"/>)",
                 three + R"(<float name="bound" value="4"/>)", {"direct", "indirect_bounded"});
    const auto two = render_statistics(
        *scene_from(box(grey, ""), 8),
        *integrator_from(R"(<integrator type="mote_vpl"><integer name="max_depth" value="2"/></integrator>)"),
        {4, 4, 23});
    CHECK(two.whole[two.layer("direct")][0].mean > 0.0);
    CHECK(two.whole[two.layer("indirect_bounded")][0].mean == 0.0);
}
TEST_CASE("bounded VPLs equal bounded paths: glossy", "[vpl][equality]") {
    check_bounded(box(glossy, ""), false, 4.0);
    check_bounded(box(mixed, ""), false, 4.0);
}
TEST_CASE("bounded VPLs equal bounded paths: homogeneous medium", "[vpl][equality][media]") {
    check_bounded(box(grey, fog("0.8, 1.0, 1.3", "")), true, 4.0);
    check_bounded(
        box(grey, fog("0.8, 1.0, 1.3", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)")), true,
        4.0);
}
TEST_CASE("bounded VPLs equal bounded paths: heterogeneous medium", "[vpl][equality][media]") {
    const std::string path = (std::filesystem::temp_directory_path() / "mote_vpl_equality.vol").string();
    check_bounded(box(grey, smoke_medium(path)), true, 4.0);
    std::filesystem::remove(path);
}

TEST_CASE("bounded VPLs equal bounded paths: masks and normal maps", "[vpl][equality][mask][normalmap]") {
    // Four edges, panes that are passed not counted: short paths leave time for more of them.
    const std::string four = R"(<integer name="max_depth" value="4"/>)";
    const std::string bounded_paths = four + R"(<float name="vpl_bound" value="4"/>)",
                      bounded_vpls = four + R"(<float name="bound" value="4"/>)";
    check_layers(leafy_box(""), bounded_paths, bounded_vpls, {"direct", "indirect_bounded", "beauty"}, 4000,
                 16000);
    check_layers(leafy_box(fog("0.8, 1.0, 1.3", "")), bounded_paths, bounded_vpls,
                 {"direct", "indirect_bounded", "beauty", "single_scattering", "multiple_scattering_bounded"},
                 2000, 24000);
}

// A ball of ground glass with fog in it: its surface scatters, and a connection goes through the fog or
// beside it by the side that it leaves to.
TEST_CASE("bounded VPLs equal bounded paths: fog behind ground glass", "[vpl][equality][media]") {
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"), R"(<shape type="sphere"><point name="center" x="-0.2" y="0" z="0.4"/>
        <float name="radius" value="0.6"/><bsdf type="roughdielectric"><float name="alpha" value="0.5"/></bsdf>)" +
                                        fog("3, 2, 1.5", "") + "</shape>");
    check_bounded(xml, false, 4.0);  // no layer begins in the fog: every eye ray meets the glass first
}

// Interpolated normals need the adjoint correction where light is traced from the light (Veach 1997,
// Sec. 5.3).
TEST_CASE("bounded VPLs equal bounded paths: smooth normals", "[vpl][equality]") {
    const std::string path = (std::filesystem::temp_directory_path() / "mote_vpl_equality.obj").string();
    std::ofstream(path) << coarse_sphere();
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"), fmt::format(R"(<shape type="obj"><string name="filename" value="{}"/>
        <transform name="to_world"><scale value="0.45"/><translate x="-0.4" y="0.1" z="0.2"/></transform>{}</shape>)",
                                                path, grey));
    check_bounded(xml, false, 4.0);
    std::filesystem::remove(path);
}

TEST_CASE("bounded VPLs equal bounded paths: every kind of light", "[vpl][equality]") {
    const std::string lights =
        R"(<emitter type="constant"><rgb name="radiance" value="0.3, 0.4, 0.5"/></emitter>
        <emitter type="directional"><vector name="direction" x="-0.3" y="-1" z="-0.4"/><rgb name="irradiance" value="1"/></emitter>
        <emitter type="spot"><rgb name="intensity" value="6"/><transform name="to_world">
            <lookat origin="0.2, 1, 1.5" target="0, -0.5, 0" up="0, 1, 0"/></transform></emitter>
        <emitter type="point"><point name="position" x="0.4" y="0.2" z="0.8"/><rgb name="intensity" value="0.5"/></emitter>)";
    // The box stands open to the front, where light at infinity and the camera look in.
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"), lights);
    check_bounded(xml, false, 4.0, 160);  // a good part of the particles miss the box
}

// Between two parallel planes no receiver comes nearer to a VPL that it sees than their distance: unbounded
// VPLs have a finite variance there, and must equal the true transport.
TEST_CASE("unbounded VPLs equal paths where VPLs cannot come near", "[vpl][equality]") {
    const std::string xml = R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.5, 0.3"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="1"/></transform>
            <bsdf type="roughplastic"><float name="alpha" value="0.4"/></bsdf></shape>
        <emitter type="point"><point name="position" x="0.3" y="0.1" z="0.5"/><rgb name="intensity" value="2"/></emitter>
        <sensor type="orthographic"><transform name="to_world"><scale value="0.9"/>
            <lookat origin="0, 0, 0.4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    check_layers(xml, "", R"(<float name="bound" value="-1"/>)", {"direct", "indirect", "beauty"});
    // Equality in an absorbing medium: transmittance along eye rays, connections and light paths.
    std::string foggy = xml;
    foggy.insert(foggy.find("<emitter"),
                 R"(<shape type="cube"><transform name="to_world"><scale x="3" y="3" z="3"/></transform>
        <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.3, 0.6, 1.2"/>
        <rgb name="albedo" value="0"/></medium></shape>)");
    check_layers(foggy, "", R"(<float name="bound" value="-1"/>)", {"direct", "indirect", "beauty"});
}
