// Boundaries of media that coincide with walls, floors and blocks: every integrator gives the picture of the
// same medium that reaches a little into the walls, where nothing coincides.
#include <fmt/format.h>

#include "core/objects/error.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// A room from -1.1 to 1.1, turned so that no plane is exact in single precision, and open at its front; fog
/// fills it up to `beyond` behind its walls, around a block whose faces an inner box of denser fog shares.
std::string foggy_room(double beyond) {
    const std::string turned = R"(<scale value="1.1"/><rotate x="0.3" y="1" z="0.2" angle="17"/>
        <translate x="0.1" y="-0.2" z="0.3"/></transform>)";
    const auto shape = [&](const std::string& type, const std::string& transform, const std::string& rest) {
        return fmt::format(R"(<shape type="{}"><transform name="to_world">{}{}{}</shape>)", type, transform,
                           turned, rest);
    };
    const auto filled = [](double sigma_t) {
        return fmt::format(R"(<bsdf type="null"/><medium type="homogeneous" name="interior">
            <rgb name="sigma_t" value="{}"/><rgb name="albedo" value="0.8"/></medium>)",
                           sigma_t);
    };
    std::string xml;
    for (const char* turn : {"", R"(<rotate x="1" angle="-90"/>)", R"(<rotate x="1" angle="90"/>)",
                             R"(<rotate y="1" angle="90"/>)", R"(<rotate y="1" angle="-90"/>)"})
        xml += shape("rectangle", std::string(R"(<translate z="-1"/>)") + turn, grey);
    const std::string block = R"(<translate x="0.4" y="-0.7" z="-0.2"/>)";
    xml += shape("cube", R"(<scale value="0.3"/>)" + block, grey);
    xml += shape("rectangle", R"(<scale value="0.3"/><rotate x="1" angle="90"/><translate y="0.95"/>)",
                 R"(<emitter type="area"><rgb name="radiance" value="8, 7, 6"/></emitter>)");
    xml += shape("cube", fmt::format(R"(<scale value="{:.17g}"/>)", 1.0 + beyond), filled(0.4));
    // On the block from above: their common face is the bottom of the box.
    xml += shape(
        "cube",
        fmt::format(R"(<scale x="0.3" y="{0:.17g}" z="0.3"/><translate x="0.4" y="{1:.17g}" z="-0.2"/>)",
                    0.2 + 0.5 * beyond, -0.2 - 0.5 * beyond),
        filled(1.5));
    return R"(<scene version="3.0.0">)" + xml +
           R"(<sensor type="perspective"><float name="fov" value="45"/><transform name="to_world">
           <lookat origin="0.9, 0, 4" target="0.1, -0.2, 0.3" up="0, 1, 0"/></transform></sensor></scene>)";
}

}  // namespace

TEST_CASE("media reach up to the surfaces that coincide with their boundaries, in every integrator",
          "[coincident]") {
    const auto shared = scene_from(foggy_room(0.0), 8), apart = scene_from(foggy_room(1e-4), 8);
    int compared = 0;
    for (const std::string& type : registry().types(core::Category::integrator)) {
        const auto integrator = integrator_from(
            fmt::format(R"(<integrator type="{}">{}</integrator>)", type, quick_settings(type)));
        INFO(type);
        try {
            const auto picture = [&](const core::Scene& scene, std::uint64_t seed) {
                return render_statistics(scene, *integrator, {4, 32, seed});
            };
            check_same_mean(picture(*shared, 3), "beauty", picture(*apart, 3), "beauty");
            ++compared;
        } catch (const core::InputError& error) {
            CHECK(std::string(error.what()).find("renders surfaces only") != std::string::npos);
        }
    }
    CHECK(compared >= 9);
}

TEST_CASE("A light on a ceiling does not light the ceiling where it stands, in any integrator",
          "[coincident]") {
    const auto scene = scene_from(R"(<scene version="3.0.0"><sensor type="perspective">
        <float name="fov" value="45"/><transform name="to_world">
        <lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform></sensor><shape type="cube">
        <transform name="to_world"><scale value="3"/><translate y="1" z="2"/></transform>)" +
                                      grey + R"(</shape><emitter type="point">
        <point name="position" x="0" y="4" z="1"/></emitter></scene>)",
                                  8);
    const auto picture = [&](const std::string& xml, std::uint32_t passes) {
        return render_statistics(*scene, *integrator_from(xml), {4, passes, 3});
    };
    const auto reference = picture(R"(<integrator type="volpath"/>)", 256);
    for (const char* xml :
         {R"(<integrator type="mote_bdpt"/>)", R"(<integrator type="mote_vpl">
            <integer name="paths" value="40"/><compensation type="exact"/></integrator>)",
          R"(<integrator type="mote_ray_lights"><integer name="paths" value="40"/></integrator>)",
          R"(<integrator type="mote_vpl_ray_bundles"><integer name="paths" value="40"/></integrator>)"}) {
        INFO(xml);
        check_same_mean(picture(xml, 64), "beauty", reference, "beauty");
    }
}
