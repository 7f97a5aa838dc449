// Pictures through media that only absorb: closed forms in one pass, and light found by two techniques.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

/// A slab between the heights y0 and y1, far wider than high.
std::string slab(double y0, double y1, const std::string& medium) {
    return fmt::format(R"(<shape type="cube"><transform name="to_world"><scale x="100" y="{}" z="100"/>
        <translate y="{}"/></transform><bsdf type="null"/>{}</shape>)",
                       0.5 * (y1 - y0), 0.5 * (y0 + y1), medium);
}
const std::string homogeneous = R"(<medium type="homogeneous" name="interior">
    <rgb name="sigma_t" value="0.2, 1.5, 6"/><rgb name="albedo" value="0"/></medium>)";
const std::string constant_grid = R"(<medium type="heterogeneous" name="interior">
    <volume name="sigma_t" type="constvolume"><rgb name="value" value="0.2, 1.5, 6"/></volume>
    <rgb name="albedo" value="0"/></medium>)";
const double sigma[] = {0.2, 1.5, 6.0};

/// Looking down on the origin from `height`.
std::string camera(double height, double half_width) {
    return fmt::format(R"(<sensor type="orthographic"><transform name="to_world"><scale x="{0}" y="{0}"/>
        <lookat origin="0, {1}, 0" target="0, 0, 0" up="0, 0, 1"/></transform></sensor>)",
                       half_width, height);
}

/// Radiance that a diffuse floor of reflectance 0.5 at the origin sends up, lit with radiance 3 by a square
/// of edge 4 at the height 2, through half a metre of a slab: by the midpoint rule.
double lit_floor(double sigma_t) {
    const int n = 800;
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = 4.0 * (i + 0.5) / n - 2.0, z = 4.0 * (j + 0.5) / n - 2.0;
            const double square = x * x + z * z + 4.0, cosine = 2.0 / std::sqrt(square);
            sum += cosine * cosine / square * std::exp(-0.5 * sigma_t / cosine);
        }
    return 0.5 / std::acos(-1.0) * 3.0 * sum * 16.0 / (n * n);
}

}  // namespace

TEST_CASE("behind a chromatic absorbing slab one pass is the closed form", "[analytic][media][absorbing]") {
    for (const std::string& medium : {homogeneous, constant_grid}) {
        const auto scene = scene_from(
            R"(<scene version="3.0.0"><emitter type="constant"><rgb name="radiance" value="2"/></emitter>)" +
            slab(0.5, 1.5, medium) + camera(4.0, 1.0) + "</scene>");
        const auto render =
            render_statistics(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), {4, 1, 3});
        const auto& blocks = render.blocks[render.layer("beauty")];
        for (std::size_t i = 0; i < blocks.size(); ++i)
            REQUIRE(blocks[i].mean == Approx(2.0 * std::exp(-sigma[i % 3])).epsilon(1e-5));
    }
}

TEST_CASE("an area light behind an absorbing slab, by both techniques and by each",
          "[analytic][media][absorbing]") {
    const std::string lamp = R"(<shape type="rectangle"><transform name="to_world"><scale value="2"/>
        <rotate x="1" angle="90"/><translate y="2"/></transform>
        <emitter type="area"><rgb name="radiance" value="3"/></emitter></shape>)";
    const std::string floor = R"(<shape type="rectangle"><transform name="to_world"><scale value="50"/>
        <rotate x="1" angle="-90"/></transform><bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf></shape>)";
    for (const std::string& medium : {homogeneous, constant_grid}) {
        const auto scene = scene_from("<scene version=\"3.0.0\">" + lamp + floor + slab(0.5, 1.0, medium) +
                                          camera(0.25, 1e-4) + "</scene>",
                                      4);
        const auto render = render_statistics(
            *scene,
            *integrator_from(
                R"(<integrator type="volpath"><integer name="max_depth" value="2"/></integrator>)"),
            {4, 20000, 5});
        const auto& whole = render.whole[render.layer("beauty")];
        for (std::size_t c = 0; c < 3; ++c) {
            const double expected = lit_floor(sigma[c]), error = std::sqrt(whole[c].variance_of_mean);
            INFO("channel " << c << ": " << whole[c].mean << " +- " << error << " against " << expected);
            CHECK(std::fabs(whole[c].mean - expected) < 4.0 * error + 1e-5 * expected);
            CHECK(error < 0.003 * expected);  // an error of 2 % would be seen
        }
    }
}
