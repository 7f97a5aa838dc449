// The G-buffer against geometry that is known.
#include "screenspace/g_buffer/g_buffer.h"

#include "core/scene/scene.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

std::unique_ptr<Scene> wall(
    int size) {  // a wall of 2 x 2 m, 3 m away; a quarter of the picture's width sees past it
    return tests::scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>
        <emitter type="point"><point name="position" x="0" y="0" z="3"/></emitter>
        <sensor type="perspective"><float name="fov" value="60"/><transform name="to_world">
          <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                             size);
}

}  // namespace

TEST_CASE("Pixels cover the picture's solid angle, and a wall's area", "[g_buffer]") {
    const int size = 64;
    const auto scene = wall(size);
    const GBuffer g = make_g_buffer(*scene, scene->camera(), size, size);
    double solid_angle = 0.0, area = 0.0;
    for (std::size_t i = 0; i < g.pixel_count(); ++i) {
        solid_angle += g.solid_angle[i], area += g.surface_area(i);
        if (!g.hit[i]) continue;
        CHECK(g.position[i].z == Approx(0.0f).margin(1e-5));
        CHECK(g.distance[i] == Approx(glm::length(g.position[i] - Vec3(0, 0, 3))).epsilon(1e-5));
        CHECK(glm::dot(g.geometric_normal[i], g.view[i]) < 0.0f);
        CHECK(g.reflectance[i].y == Approx(0.4f));
    }
    // A square pyramid of half angle a: 4 asin(sin^2 a).
    CHECK(solid_angle == Approx(4.0 * std::asin(0.25)).epsilon(1e-5));
    // The wall's border falls within a pixel on each side: its area is known to one row of pixels.
    const double pixel = 2.0 * 3.0 * std::tan(double(pi) / 6.0) / size;
    CHECK(std::abs(area - 4.0) < 4.0 * 2.0 * pixel);
    CHECK(g.hit[g.index(0, 0)] == 0);
    CHECK(g.distance[g.index(0, 0)] == infinity);
}

TEST_CASE("A G-buffer of nothing is refused", "[g_buffer]") {
    CHECK_THROWS_AS(GBuffer(0, 4), std::invalid_argument);
}
