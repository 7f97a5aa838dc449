// Shadow rays far from the origin of coordinates, where rounding moves both of their ends.
#include <fmt/format.h>

#include "core/geometry/shadow_segment.h"
#include "core/geometry/shape.h"
#include "lights/virtual_lights/particle_tracer.h"
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

// VPLs are moved off their surface by its rounding, so that a constant fraction of the segment serves as well
// as shadow_fraction() where single precision distinguishes walls at all.
TEST_CASE("shadow rays end before the surface of a VPL, wherever the room is and however small",
          "[vpl][shadow]") {
    struct Place {
        double size, x, y, z;  ///< [m]
    };
    for (const auto& [size, x, y, z] :
         {Place{2, 0, 0, 0}, Place{2, 10000, 7000, -4000}, Place{200, 1e6, 7e5, -4e5}, Place{1e-6, 0, 0, 0},
          Place{1e-6, 0.01, 0.007, -0.004}}) {
        INFO("size " << size << ", x " << x);
        std::string walls;
        for (const char* turn : {"", "<rotate x='1' angle='-90'/>", "<rotate x='1' angle='90'/>",
                                 "<rotate y='1' angle='90'/>", "<rotate y='1' angle='-90'/>"})
            walls += fmt::format(
                "<shape type='rectangle'><transform name='to_world'><translate z='-1'/>{}<rotate x='0.3' "
                "y='1' "
                "z='0.2' angle='17'/><scale value='{}'/><translate x='{}' y='{}' "
                "z='{}'/></transform></shape>",
                turn, size, x, y, z);
        const auto scene = scene_from(
            "<scene version='3.0.0'>" + walls +
            fmt::format("<emitter type='point'><point name='position' x='{}' y='{}' z='{}'/></emitter>"
                        "<sensor type='perspective'/></scene>",
                        x, y, z));
        lights::LightPathSettings settings;
        settings.paths = 2000;
        const auto set = lights::trace_light_paths(*scene, settings, 1, 0, SamplerKind::independent);
        REQUIRE(set.lights.size() > 1000);
        Rng rng(1);
        int rays = 0, hidden = 0, hidden_by_fraction = 0;
        for (const auto& vpl : set.lights) {
            const Shape& wall = *scene->shapes()[std::size_t(rng.next_float() * 5.0f) % 5];
            const ShapeSample at = wall.sample_area(rng.next_vec2());
            const Vec3 towards = glm::normalize(vpl.position - at.position);
            const float distance = glm::length(vpl.position - at.position);
            // Pairs on one wall, and ones that nearly are, see each other at a grazing angle or not at all.
            if (glm::dot(towards, at.normal) < 0.05f || glm::dot(towards, vpl.normal) > -0.05f) continue;
            if (distance < 1e-3f * float(size)) continue;
            const Vec3 origin = offset_origin(at.position, at.normal, at.error, towards);
            const Vec3 segment = vpl.position - origin;
            const auto is_hidden = [&](float end) {
                Ray shadow{origin, segment};
                shadow.t_max = end;
                return !scene->visible(shadow);
            };
            ++rays;
            hidden += is_hidden(shadow_fraction(origin, 1.0f / glm::length(segment)));
            hidden_by_fraction += is_hidden(0.9999f);
        }
        INFO(hidden << " hidden, " << hidden_by_fraction << " by the fraction alone, of " << rays);
        CHECK(rays > 500);
        CHECK(hidden <= rays / 500);
        CHECK(hidden_by_fraction <= rays / 500);
    }
}
