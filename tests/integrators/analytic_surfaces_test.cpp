// Scenes without media whose radiance is known in closed form, rendered by every integrator that can.
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

const std::string surface_integrators[] = {
    R"(<integrator type="path"/>)", R"(<integrator type="volpath"/>)",
    R"(<integrator type="mote_vpl"><integer name="paths" value="128"/><float name="bound" value="-1"/></integrator>)"};

}  // namespace

// Inside a closed diffuse sphere of albedo a that emits L_e everywhere, radiance is L_e (1 + a + a^2 + ...) =
// L_e / (1 - a). The geometry term between two points of a sphere is constant, 1/(4 R^2), so unbounded VPLs
// have a finite variance here.
TEST_CASE("closed emitting sphere is L_e / (1 - a)", "[analytic][furnace]") {
    for (const double albedo : {0.0, 0.5, 0.8}) {
        const auto scene = scene_from(R"(<scene version="3.0.0"><shape type="sphere">
            <float name="radius" value="2"/><boolean name="flip_normals" value="true"/>
            <bsdf type="diffuse"><rgb name="reflectance" value=")" +
                                      std::to_string(albedo) + R"("/></bsdf>
            <emitter type="area"><rgb name="radiance" value="1.5"/></emitter></shape>
            <sensor type="perspective"><float name="fov" value="80"/><transform name="to_world">
            <translate x="0.3" y="-0.4" z="0.2"/></transform></sensor></scene>)");
        for (const std::string& integrator : surface_integrators) {
            INFO(integrator << " albedo " << albedo);
            const auto render = render_statistics(*scene, *integrator_from(integrator), {16, 100, 3});
            check_mean_is(render, "beauty", 1.5 / (1.0 - albedo));
            if (albedo > 0.0)
                CHECK_FALSE(mean_is(render.scaled(1.02), "beauty", 1.5 / (1.0 - albedo)).passed);
        }
    }
}

// Two parallel unit squares at distance one: F12 = 0.199824895698... (Howell, configuration C-11), so a
// diffuse receiver of reflectance rho shows the mean radiance rho L_e F12 when nothing else reflects.
TEST_CASE("form factor of two parallel squares", "[analytic][form_factor]") {
    const double x = 1.0, x1 = std::sqrt(1.0 + x * x);
    const double f12 = 2.0 / (std::acos(-1.0) * x * x) *
                       (std::log(std::sqrt((x1 * x1) * (x1 * x1) / (1.0 + 2.0 * x * x))) +
                        2.0 * x * x1 * std::atan(x / x1) - 2.0 * x * std::atan(x));
    const auto scene = scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate z="2"/></transform>
            <emitter type="area"><rgb name="radiance" value="3"/></emitter></shape>
        <sensor type="orthographic"><transform name="to_world">
            <lookat origin="0, 0, 1" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)");
    for (const std::string& integrator : surface_integrators) {
        INFO(integrator);
        const auto render = render_statistics(*scene, *integrator_from(integrator), {16, 400, 5});
        check_mean_is(render, "beauty", 0.6 * 3.0 * f12, {1.02});
    }
}
