// Masks and normal maps as integrators see them: a mask with nothing behind it is a darker surface; holes in
// a black wall let as much light pass as they are large; path and volpath agree.
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

struct Method {
    std::string xml, indirect;  ///< its layer of light scattered more than once
    std::uint32_t passes;       ///< as many as show an error of 6 % in that layer
};
const Method methods[] = {
    {R"(<integrator type="path"/>)", "indirect", 3600},
    {R"(<integrator type="volpath"/>)", "indirect", 3600},
    {R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="4"/></integrator>)",
     "indirect_bounded", 4800},
    {R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="4"/>
        <visibility type="shadow_map"><integer name="size" value="16"/></visibility></integrator>)",
     "indirect_bounded", 4800},
    // The radius of spherical lights and photons goes by how many lie near, and fewer lie on a mask. Where it
    // is small, the blur, which differs, is far below what is looked for here.
    {R"(<integrator type="mote_vsl"><integer name="paths" value="16"/><float name="radius_scale" value="0.1"/></integrator>)",
     "indirect_spherical", 4800},
    {R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="1000"/><integer name="neighbours" value="8"/></integrator>)",
     "indirect", 3600},
};

RenderStatistics render(const core::Scene& scene, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    return render_statistics(scene, *integrator_from(integrator), {4, passes, seed});
}

/// A floor, lit by a lamp and by a wall beside it; below it there is nothing, and all that passes is lost.
std::string floor_of(const std::string& bsdf) {
    return R"(<scene version="3.0.0"><shape type="rectangle"><transform name="to_world"><scale value="1.5"/></transform>)" +
           bsdf + R"(</shape>
        <shape type="rectangle"><transform name="to_world"><scale value="1.5"/><rotate y="1" angle="90"/>
            <translate x="-1.5" z="1.5"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.9, 0.8, 0.7"/></bsdf></shape>
        <emitter type="point"><point name="position" x="-0.4" y="0.2" z="1.1"/><rgb name="intensity" value="3"/></emitter>
        <sensor type="perspective"><float name="fov" value="30"/><transform name="to_world">
            <lookat origin="0.4, -1.5, 1.5" target="0, 0, 0" up="0, 0, 1"/></transform></sensor></scene>)";
}
std::string diffuse(const std::string& reflectance) {
    return R"(<bsdf type="diffuse"><rgb name="reflectance" value=")" + reflectance + R"("/></bsdf>)";
}

}  // namespace

TEST_CASE("a mask over nothing is a darker surface, in every integrator", "[mask][equality]") {
    const auto masked = scene_from(floor_of(R"(<bsdf type="mask"><float name="opacity" value="0.6"/>)" +
                                            diffuse("0.9, 0.8, 0.7") + "</bsdf>"),
                                   8),
               dark = scene_from(floor_of(diffuse("0.54, 0.48, 0.42")), 8);
    std::uint64_t seed = 1;
    for (const Method& method : methods) {
        const auto a = render(*masked, method.xml, method.passes, seed++),
                   b = render(*dark, method.xml, method.passes, seed++);
        INFO(method.xml);
        for (const std::string& layer : {std::string("direct"), method.indirect}) {
            check_same_mean(a, layer, b, layer, {1.06, 0.94});
        }
    }
}

TEST_CASE("connections pass a mask by its opacity at that place", "[mask]") {
    // Between lamp and floor a black card, 1 - 0.7 of which is holes on one side and 1 - 0.2 on the other.
    const std::string card =
        R"(<shape type="rectangle"><transform name="to_world"><translate z="1"/></transform>
        <bsdf type="mask"><texture type="checkerboard" name="opacity"><float name="color0" value="0.2"/>
        <float name="color1" value="0.7"/><transform name="to_uv"><scale x="1" y="0.1"/></transform></texture>)" +
        diffuse("0") + "</bsdf></shape>";
    const auto seen_at = [&](double x, const std::string& more) {
        return scene_from(fmt::format(R"(<scene version="3.0.0"><shape type="rectangle">{}</shape>{}
            <emitter type="point"><point name="position" x="{}" y="0" z="2"/></emitter>
            <sensor type="orthographic"><transform name="to_world"><scale value="0.01"/>
            <lookat origin="{}, 0, 0.1" target="{}, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                                      diffuse("0.5"), more, x, x, x),
                          4);
    };
    for (const double x : {-0.5, 0.5}) {
        const auto open = seen_at(x, ""), covered = seen_at(x, card);
        // color1 is the number of the first square, as in Mitsuba (Texture::scalar).
        const double passes = x < 0.0 ? 0.3 : 0.8;
        for (const Method& method : methods) {
            INFO(method.xml << " at " << x);
            const auto a = render(*covered, method.xml, 16, 5), b = render(*open, method.xml, 16, 5);
            const auto mean = [](const RenderStatistics& s) { return s.whole[s.layer("direct")][0].mean; };
            CHECK(mean(a) == Approx(passes * mean(b)).epsilon(1e-5));
        }
    }
}

TEST_CASE("path and volpath agree on masks and normal maps", "[mask][normalmap][equality]") {
    const auto scene = scene_from(leafy_box(""), 8);
    const auto a = render(*scene, methods[0].xml, 4000, 11), b = render(*scene, methods[1].xml, 4000, 12);
    for (const std::string layer : {"direct", "beauty"}) {
        check_same_mean(a, layer, b, layer, {1.05});
    }
}

TEST_CASE("a mask is a grey pane, and no lamp", "[mask]") {
    const auto scene = scene_from(floor_of(R"(<bsdf type="mask"><float name="opacity" value="0.4"/>)" +
                                           diffuse("0.9, 0.8, 0.7") + "</bsdf>"),
                                  4);
    CHECK(scene->has_panes());
    CHECK_FALSE(scene->has_coloured_panes());
    CHECK_THROWS_AS(
        scene_from(floor_of(R"(<bsdf type="mask">)" + diffuse("0.5") + R"(</bsdf><emitter type="area"/>)"),
                   4),
        core::InputError);
}
