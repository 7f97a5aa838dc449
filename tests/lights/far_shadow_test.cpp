// Shadow rays far from the origin of coordinates, where rounding moves both of their ends.
#include "core/geometry/shadow_segment.h"
#include "core/geometry/shape.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

TEST_CASE("a light is seen from a floor that lies thousands of its sizes from the origin",
          "[emitters][shadow]") {
    for (const std::string& offset :
         {std::string("x='0' y='0' z='0'"), std::string("x='10000' y='7000' z='-4000'"),
          std::string("x='57776' y='40443' z='-23110'")}) {
        const std::string far = "<translate " + offset + "/></transform>";
        const auto scene = scene_from(
            "<scene version='3.0.0'><shape type='rectangle'><transform name='to_world'><scale value='2'/>"
            "<rotate x='1' angle='-90'/><translate y='-2'/>" +
            far +
            "</shape><shape type='rectangle'><transform name='to_world'><scale value='2'/><rotate x='1' "
            "angle='90'/><translate y='2'/>" +
            far + "<emitter type='area'/></shape><sensor type='perspective'/></scene>");
        const Shape& floor = *scene->shapes()[0];
        const Emitter& lamp = *scene->shapes()[1]->emitter;
        Rng rng(1);
        int hidden = 0, hidden_by_fraction = 0;
        constexpr int rays = 4000;
        for (int i = 0; i < rays; ++i) {
            const ShapeSample at = floor.sample_area(rng.next_vec2());
            const auto light = lamp.sample_direct(at.position, rng.next_vec2());
            REQUIRE(light);
            Ray shadow{offset_origin(at.position, at.normal, at.error, light->wi), light->wi};
            shadow.t_max = shadow_end(shadow.origin, light->distance);
            hidden += !scene->visible(shadow);
            shadow.t_max = 0.9999f * light->distance;
            hidden_by_fraction += !scene->visible(shadow);
        }
        INFO(offset << ": " << hidden << " hidden, " << hidden_by_fraction << " by the fraction alone");
        CHECK(hidden < rays / 500);
        if (offset.find("7000") != std::string::npos) CHECK(hidden_by_fraction > rays / 4);
    }
}
