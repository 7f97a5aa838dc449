// Open walls part the outside: a half-space of water under a sky. Over an infinite distance water transmits
// nothing, so light comes from above alone.
#include "core/scene/light_from_infinity.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::unique_ptr<Scene> water(const std::string& light) {
    return scene_from(R"(<scene version="3.0.0"><sensor type="perspective"><transform name="to_world">
        <lookat origin="0, 1, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="rectangle"><transform name="to_world"><scale value="20"/><rotate x="1" angle="-90"/></transform>
            <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="1"/>
            <rgb name="albedo" value="0.5"/></medium></shape>)" +
                      light + "</scene>");
}

/// A plate above the water, which faces it.
const std::string plate =
    "<shape type='rectangle'><transform name='to_world'><scale value='3'/><rotate x='1' angle='90'/>"
    "<translate y='5'/></transform></shape>";

}  // namespace

TEST_CASE("particles of a sky begin in the medium on their side of open walls", "[emitters][media]") {
    const auto scene = water("<emitter type='constant'/>");
    const Emitter& sky = *scene->environment();
    Rng rng(3);
    int below = 0;
    for (int i = 0; i < 4000; ++i) {
        const auto sample = sky.sample_emission(rng.next_vec2(), rng.next_vec2());
        REQUIRE(sample);
        const Vec3 o = sample->origin;
        // Beyond its edges the surface parts nothing.
        if (std::fabs(o.x) > 15.0f || std::fabs(o.z) > 15.0f || std::fabs(o.y) < 10.0f) continue;
        const bool in_water = sample->origin.y < 0.0f;
        const MediumState state = scene->emitter_medium_state(sky, *sample);
        INFO("origin " << sample->origin.x << " " << sample->origin.y << " " << sample->origin.z);
        REQUIRE(bool(state.current()) == in_water);
        REQUIRE(reaches_scene(sky, state) == !in_water);
        below += in_water;
    }
    CHECK(below > 20);
}

TEST_CASE("light from infinity does not come through water without end", "[emitters][media]") {
    lights::LightPathSettings settings;
    settings.paths = 20000;
    for (const std::string& light :
         {std::string("<emitter type='constant'/>"),
          std::string(
              "<emitter type='directional'><vector name='direction' value='0.1, 1, 0'/></emitter>")}) {
        const auto scene = water(light + plate);
        const auto set = lights::trace_light_paths(*scene, settings, 1, 0, SamplerKind::independent);
        int deep = 0, from_below = 0;
        for (const auto& vpl : set.lights) {
            deep += vpl.position.y < -10.0f;
            from_below += vpl.depth == 1 && vpl.normal.y < -0.5f;  // on the lower side of the plate
        }
        INFO(light << ": " << deep << " of " << set.lights.size() << " VPLs are deep below");
        CHECK(deep < 20);        // 20,000 e^-10 from above: one
        CHECK(from_below < 25);  // some pass the edges of the sky's water; without water, 76 and 279 come
        if (light.find("constant") != std::string::npos) CHECK(set.lights.size() > 1000);
    }
}
