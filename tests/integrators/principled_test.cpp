// "principled" and "principledthin" are the same surfaces from the eye's end and from the light's: virtual
// point lights and photons, which travel as power through frosted glass and sheets, give the picture of path.
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

const std::string coated = R"(<bsdf type="principled"><rgb name="base_color" value="0.7, 0.5, 0.3"/>
    <float name="metallic" value="0.3"/><float name="roughness" value="0.7"/><float name="anisotropic" value="0.5"/>
    <float name="sheen" value="0.4"/><float name="clearcoat" value="0.8"/></bsdf>)";
const std::string glass = R"(<shape type="sphere"><point name="center" x="-0.3" y="-0.4" z="0.1"/>
    <float name="radius" value="0.4"/><bsdf type="principled"><rgb name="base_color" value="0.9, 0.7, 0.8"/>
    <float name="spec_trans" value="0.8"/><float name="roughness" value="0.7"/></bsdf></shape>)";
const std::string sheet = R"(<shape type="rectangle"><transform name="to_world"><scale value="0.5"/>
    <rotate x="1" angle="70"/><translate x="0.2" y="0.3"/></transform><bsdf type="principledthin">
    <rgb name="base_color" value="0.5, 0.8, 0.6"/><float name="spec_trans" value="0.6"/>
    <float name="roughness" value="0.8"/><float name="diff_trans" value="1"/></bsdf></shape>)";

/// Scene of the box with `things` in it.
std::string room(const std::string& things) {
    std::string xml = box("<bsdf type=\"twosided\">" + coated + "</bsdf>", "");
    xml.insert(xml.find("<sensor"), things);
    return xml;
}

void check_same(const RenderStatistics& ours, const RenderStatistics& reference, const std::string& layer,
                double planted) {
    check_same_mean(ours, layer, reference, layer, {1.0 + planted, 1.0 - planted});
}

}  // namespace

TEST_CASE("bounded VPLs equal bounded paths: principled surfaces, glass and sheets",
          "[vpl][equality][principled]") {
    const auto scene = scene_from(room(glass + sheet), 8);
    const auto vpl = render_statistics(
        *scene, *integrator_from(R"(<integrator type="mote_vpl"><integer name="paths" value="24"/>
            <float name="bound" value="4"/></integrator>)"),
        {4, 1500, 21});
    const auto reference = render_statistics(
        *scene,
        *integrator_from(R"(<integrator type="volpath"><float name="vpl_bound" value="4"/></integrator>)"),
        {4, 8000, 22});
    for (const char* layer : {"direct", "indirect_bounded", "beauty"})
        check_same(vpl, reference, layer, 0.05);
}

TEST_CASE("photons that went through a principled sheet agree with path",
          "[photon_map][equality][principled]") {
    // The camera sees the middle of a principled plane; a sheet hangs between it and a lamp that faces it.
    const auto scene = scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><scale value="4"/></transform>)" +
                                      coated + R"(</shape>
        <shape type="rectangle"><transform name="to_world"><scale value="30"/><translate z="1.5"/></transform>
            <bsdf type="principledthin"><rgb name="base_color" value="0.8, 0.6, 0.7"/>
            <float name="spec_trans" value="0.5"/><float name="roughness" value="0.9"/>
            <float name="diff_trans" value="1"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="2"/><rotate y="1" angle="180"/>
            <translate z="2.5"/></transform><emitter type="area"/></shape>
        <sensor type="perspective"><float name="fov" value="30"/><transform name="to_world">
            <lookat origin="-1, 0, 0.8" target="0, 0, 0" up="0, 0, 1"/></transform></sensor></scene>)",
                                  8);
    const auto photons = render_statistics(
        *scene,
        *integrator_from(R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="4000"/>
            <integer name="neighbours" value="10"/></integrator>)"),
        {8, 300, 3});
    const auto reference =
        render_statistics(*scene, *integrator_from(R"(<integrator type="path"/>)"), {8, 8000, 4});
    check_same(photons, reference, "indirect", 0.08);
}
