// Thin panes: light passes them straight on, so connections do as well, and passing is no scattering. Every
// method against the closed form, against each other, and in a furnace.
#include <fmt/format.h>

#include "core/materials/bsdf.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// A black-bodied sky would be seen through it: one pane, 2 m wide, at height `z` facing up and down.
std::string pane(const std::string& transform, const std::string& parameters = "") {
    return R"(<shape type="rectangle"><transform name="to_world">)" + transform +
           R"(</transform><bsdf type="thindielectric">)" + parameters + "</bsdf></shape>";
}

/// A floor seen from just above it, where nothing stands between camera and floor.
std::string floor_seen(const std::string& more) {
    return R"(<scene version="3.0.0"><shape type="rectangle"><transform name="to_world"><scale value="0.2"/>
        </transform><bsdf type="diffuse"><rgb name="reflectance" value="0.6, 0.5, 0.4"/></bsdf></shape>)" +
           more + R"(<sensor type="orthographic"><transform name="to_world"><scale value="0.01"/>
        <lookat origin="0, 0, 0.1" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
}

/// 1 - R of a pane at normal incidence, with all reflections between its faces, by the BSDF itself.
double passes_straight() {
    const double r = (1.5046 - 1.000277) / (1.5046 + 1.000277), R = r * r;
    return 1.0 - 2.0 * R / (1.0 + R);
}

RenderStatistics render(const core::Scene& scene, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    return render_statistics(scene, *integrator_from(integrator), {4, passes, seed});
}

const std::string integrators[] = {
    R"(<integrator type="path"/>)",
    R"(<integrator type="volpath"/>)",
    R"(<integrator type="mote_bdpt"/>)",
    R"(<integrator type="mote_vpl"><integer name="paths" value="4"/></integrator>)",
    R"(<integrator type="mote_vsl"><integer name="paths" value="4"/></integrator>)",
    R"(<integrator type="mote_ray_lights"><integer name="paths" value="4"/></integrator>)",
    R"(<integrator type="mote_vpl_ray_bundles"><integer name="paths" value="4"/><integer name="directions" value="4"/></integrator>)",
    R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="50"/></integrator>)",
    R"(<integrator type="mote_micro_rendering"><integer name="points" value="100"/><integer name="micro_buffer" value="4"/></integrator>)",
    R"(<integrator type="mote_single_scattering"/>)",
    R"(<integrator type="mote_epipolar"/>)",
    R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)",
};

}  // namespace

TEST_CASE("a point light shines through panes, in every integrator", "[pane]") {
    // The lamp stands 2 m above the floor, behind three panes: E = I T^3 / 4 at the middle.
    const std::string light = R"(<emitter type="point"><point name="position" x="0" y="0" z="2"/>
        <rgb name="intensity" value="8, 8, 8"/></emitter>)";
    const auto scene = scene_from(floor_seen(pane(R"(<translate z="0.5"/>)") + pane(R"(<translate z="1"/>)") +
                                             pane(R"(<translate z="1.5"/>)") + light),
                                  4);
    const double expected = 8.0 / 4.0 * std::pow(passes_straight(), 3) / 3.14159265358979;
    for (const std::string& integrator : integrators) {
        const auto picture = render(*scene, integrator, 64, 1);
        const auto& direct = picture.whole[picture.layer("direct")];
        INFO(integrator);
        // The picture is 2 cm wide at a distance of 2 m: 1/d^2 and cosines vary by less than 1e-4.
        CHECK(direct[0].mean == Approx(0.6 * expected).epsilon(2e-4));
        CHECK(direct[2].mean == Approx(0.4 * expected).epsilon(2e-4));
        CHECK(picture.whole[picture.layer("emission")][0].mean == 0.0);
    }
}

TEST_CASE("a tinted pane tints what passes", "[pane]") {
    const std::string tint = R"(<rgb name="specular_transmittance" value="0.9, 0.5, 0.1"/>)";
    const auto scene = scene_from(
        floor_seen(pane(R"(<translate z="1"/>)", tint) +
                   R"(<emitter type="point"><point name="position" x="0" y="0" z="2"/></emitter>)"),
        4);
    const double expected = passes_straight() / 4.0 / 3.14159265358979;
    for (const std::string& integrator : integrators) {
        INFO(integrator);
        const auto picture = render(*scene, integrator, 16, 1);
        const auto& direct = picture.whole[picture.layer("direct")];
        CHECK(direct[0].mean == Approx(0.6 * 0.9 * expected).epsilon(2e-4));
        CHECK(direct[1].mean == Approx(0.5 * 0.5 * expected).epsilon(2e-4));
        CHECK(direct[2].mean == Approx(0.4 * 0.1 * expected).epsilon(2e-4));
    }
}

// In a uniform sky nothing that loses no light is seen. Both techniques for direct light meet here: a wrong
// weight of either shows.
TEST_CASE("white surfaces and panes vanish in a furnace", "[pane]") {
    const std::string white = R"(<bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf>)";
    const std::string xml =
        R"(<scene version="3.0.0"><shape type="cube"><transform name="to_world"><scale value="0.5"/>
        </transform>)" +
        white + "</shape>" + pane(R"(<translate z="1"/>)") + pane(R"(<translate z="1.3"/>)") +
        pane(R"(<rotate y="1" angle="60"/><translate x="1"/>)") +
        R"(<emitter type="constant"/><sensor type="perspective"><float name="fov" value="50"/>
        <transform name="to_world"><lookat origin="1, 2, 4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)";
    const auto scene = scene_from(xml, 8);
    for (const std::string type : {"path", "volpath"}) {
        const auto picture = render(*scene, R"(<integrator type=")" + type + R"("/>)", 600, 7);
        check_mean_is(picture, "beauty", 1.0, {1.02, 0.98});
    }
    // Mean radiance is 1 in a fog without absorption too.
    std::string foggy = xml;
    foggy.insert(foggy.find("<sensor"),
                 R"(<shape type="sphere"><float name="radius" value="3"/><bsdf type="null"/>
        <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.3, 0.5, 0.8"/>
        <rgb name="albedo" value="1"/></medium></shape>)");
    const auto picture = render(*scene_from(foggy, 8), R"(<integrator type="volpath"/>)", 600, 8);
    check_mean_is(picture, "beauty", 1.0, {1.03});
}

// Behind a window: virtual lights shine through it, light paths and eye paths pass it, and fog before and
// behind it is lit. What the pane mirrors is left to volpath: here nothing can be seen in it.
TEST_CASE("VPLs, photons and marching see through a window as volpath does", "[pane][equality]") {
    std::string xml = box(grey, fog("0.5, 0.6, 0.8", ""));
    // The point light stands outside of the fog: inside, light at collisions would have no finite variance.
    xml.insert(xml.find("<sensor"),
               R"(<emitter type="point"><point name="position" x="-0.4" y="0.3" z="1.1"/>
        <rgb name="intensity" value="4"/></emitter>)" +
                   pane(R"(<rotate x="1" angle="90"/><translate y="0.6"/>)") +
                   pane(R"(<scale value="0.5"/><rotate y="1" angle="90"/><translate x="0.1"/>)",
                        R"(<rgb name="specular_reflectance" value="0"/>)"));
    // Mirrors that show nothing: caustics by reflection are what virtual lights cannot have.
    const std::string black = R"(<rgb name="specular_reflectance" value="0"/>)";
    xml.insert(xml.find(R"(<bsdf type="thindielectric">)") + 28, black);
    const auto scene = scene_from(xml, 8);
    const auto reference = render(
        *scene, R"(<integrator type="volpath"><float name="vpl_bound" value="4"/></integrator>)", 8000, 21);
    const auto check = [&](const RenderStatistics& ours, std::vector<std::string> layers, double power) {
        for (const std::string& layer : layers) {
            check_same_mean(ours, layer, reference, layer, {1.0 + power, 1.0 - power});
        }
    };
    check(render(*scene, R"(<integrator type="mote_vpl"><integer name="paths" value="24"/>
        <float name="bound" value="4"/></integrator>)",
                 1500, 22),
          {"direct", "single_scattering", "indirect_bounded", "multiple_scattering_bounded"}, 0.06);
    check(render(*scene, R"(<integrator type="mote_single_scattering"/>)", 400, 23),
          {"direct", "single_scattering"}, 0.06);
    check(render(
              *scene,
              R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="200"/></integrator>)",
              1500, 24),
          {"direct", "single_scattering"}, 0.06);
}
