// Methods that follow a fixed number of reflections refuse rooms where most light has more.
#include "integrators/eye_path/few_reflections.h"

#include <fmt/format.h>

#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "core/scene/requirements.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::unique_ptr<Scene> furnace(double reflectance, const std::string& more = "") {
    return scene_from(
        fmt::format(R"(<scene version="3.0.0"><sensor type="perspective"><transform name="to_world">
        <lookat origin="0, 1, 4" target="0, 1, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="cube"><transform name="to_world"><scale value="3"/><translate x="0" y="1" z="2"/></transform>
        <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="{}"/></bsdf></bsdf></shape>
        <shape type="sphere"><point name="center" x="0" y="1" z="1"/><float name="radius" value="0.3"/>
        <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>
        <emitter type="area"/></shape>{}</scene>)",
                    reflectance, more),
        8);
}

/// "" where one pass is rendered.
std::string refusal(const Scene& scene, const std::string& type, const std::string& settings) {
    const auto integrator =
        integrator_from(fmt::format(R"(<integrator type="{}">{}</integrator>)", type, settings));
    const std::string planned = integrator->plan(scene, find_requirements(scene)).to_text();
    try {
        RenderRequest request;
        request.stop.passes = 1;
        render(scene, *integrator, request);
    } catch (const InputError& error) {
        CHECK(planned.find(error.what()) != std::string::npos);
        return error.what();
    }
    CHECK(planned.find("refused") == std::string::npos);
    return "";
}

}  // namespace

/// White panels in the open, back to back and side by side.
std::unique_ptr<Scene> open_scene() {
    return scene_from(R"(<scene version="3.0.0"><sensor type="perspective"/>
        <bsdf type="twosided" id="white"><bsdf type="diffuse"><rgb name="reflectance" value="1"/></bsdf></bsdf>
        <shape type="rectangle"><ref id="white"/></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="3"/></transform><ref id="white"/></shape>
        <emitter type="point"/></scene>)",
                      8);
}

/// A room of glass.
std::unique_ptr<Scene> glass_room() {
    return scene_from(R"(<scene version="3.0.0"><sensor type="perspective"/>
        <shape type="cube"><bsdf type="thindielectric"/></shape>
        <shape type="sphere"><float name="radius" value="0.1"/><bsdf type="diffuse"/></shape>
        <emitter type="point"><point name="position" x="0.5" y="0" z="0"/></emitter></scene>)",
                      8);
}

TEST_CASE("the light of more reflections is that of a closed room", "[reflections]") {
    // The lamp reflects nothing, and is 0.5 % of all surfaces.
    CHECK(integrators::light_of_more_reflections(*furnace(0.5), 4) == Approx(0.0613).epsilon(0.01));
    CHECK(integrators::light_of_more_reflections(*furnace(1.0), 6) == Approx(0.969).epsilon(0.01));
    CHECK(integrators::light_of_more_reflections(*furnace(1.0, R"(<emitter type="constant"/>)"), 6) ==
          Approx(0.969).epsilon(0.01));
    // Two squares of side 2 at a distance of 3 exchange a tenth: F = 0.1107 (Howell, C-11).
    CHECK(integrators::light_of_more_reflections(*open_scene(), 1) == Approx(0.1107).epsilon(0.1));
    CHECK(integrators::light_of_more_reflections(*glass_room(), 6) == 0.0);
}

TEST_CASE("a white room is refused by methods that follow few reflections", "[reflections]") {
    const auto white = furnace(1.0), grey = furnace(0.6);
    const std::string few = R"(<integer name="points" value="120"/><integer name="micro_buffer" value="3"/>)";
    const std::string bundles =
        R"(<integer name="texel_budget" value="400"/><integer name="directions" value="64"/>)";
    const std::string text = refusal(*white, "mote_micro_rendering", few);
    CHECK(text.find("6 reflections, and about 9") != std::string::npos);
    CHECK(refusal(*white, "mote_ray_bundles", bundles).find("4 reflections") != std::string::npos);
    CHECK(refusal(*grey, "mote_micro_rendering", few).empty());
    CHECK(refusal(*grey, "mote_ray_bundles", bundles).empty());
    // Paths of at most eight reflections have none beyond what the points exchange; photons have all.
    CHECK(refusal(*white, "mote_micro_rendering", few + R"(<integer name="max_depth" value="8"/>)").empty());
    CHECK(refusal(*white, "mote_micro_rendering",
                  few + R"(<string name="light" value="photons"/><integer name="paths" value="200"/>)")
              .empty());
    CHECK(refusal(*white, "mote_ray_bundles",
                  R"(<integer name="texel_budget" value="400"/><integer name="directions" value="4096"/>)")
              .empty());
}
