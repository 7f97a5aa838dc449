// Scenes with media whose radiance is known in closed form or by quadrature.
#include <fmt/format.h>

#include <cmath>

#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

std::string null_sphere(const std::string& medium, double radius = 1.0) {
    return fmt::format(
        R"(<shape type="sphere"><float name="radius" value="{}"/><bsdf type="null"/>{}</shape>)", radius,
        medium);
}
std::string homogeneous(const std::string& sigma_t, const std::string& albedo, const std::string& phase) {
    return fmt::format(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="{}"/>
        <rgb name="albedo" value="{}"/>{}</medium>)",
                       sigma_t, albedo, phase);
}
std::string hg(double g) {
    return fmt::format(R"(<phase type="hg"><float name="g" value="{}"/></phase>)", g);
}
const std::string camera_at_minus_4 = R"(<sensor type="perspective"><float name="fov" value="30"/>
    <transform name="to_world"><lookat origin="0, 0, -4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)";
const std::string camera_inside = R"(<sensor type="perspective"><float name="fov" value="60"/>
    <transform name="to_world"><lookat origin="0.2, 0.1, -0.3" target="0, 0, 1" up="0, 1, 0"/></transform></sensor>)";

}  // namespace

// A medium that absorbs nothing, under a constant environment of radiance 1, is in equilibrium: 1 everywhere.
TEST_CASE("albedo-1 medium under a constant environment is 1", "[analytic][furnace][media][long]") {
    for (const double depth : {0.01, 1.0, 30.0})
        for (const double g : {-0.9, 0.0, 0.9})
            for (const std::string& camera : {camera_at_minus_4, camera_inside}) {
                const auto scene =
                    scene_from(R"(<scene version="3.0.0"><emitter type="constant"/>)" +
                               null_sphere(homogeneous(fmt::format("{}", depth / 2.0), "1", hg(g))) + camera +
                               "</scene>");
                const auto render = render_statistics(
                    *scene, *integrator_from(R"(<integrator type="volpath"/>)"), {8, 200, 7});
                INFO("optical depth " << depth << " g " << g);
                check_mean_is(render, "beauty", 1.0);
                // The medium is really there: part of the light has been scattered.
                CHECK(render.whole[render.layer("single_scattering")][0].mean > 0.0);
                if (depth > 10.0) CHECK(render.whole[render.layer("multiple_scattering")][0].mean > 0.2);
            }
}

TEST_CASE("absorbing slab is exp(-sigma d)", "[analytic][media]") {
    const std::string integrators[] = {
        R"(<integrator type="volpath"/>)",
        R"(<integrator type="mote_vpl"><integer name="paths" value="1"/></integrator>)"};
    const auto scene = scene_from(
        R"(<scene version="3.0.0"><emitter type="constant"><rgb name="radiance" value="2"/></emitter>
        <shape type="cube"><transform name="to_world"><scale x="100" y="100" z="0.5"/></transform><bsdf type="null"/>)" +
        homogeneous("0.01, 1, 4", "0", "") +
        R"(</shape><sensor type="orthographic"><transform name="to_world">
        <lookat origin="0, 0, -4" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)");
    for (const std::string& integrator : integrators) {
        INFO(integrator);
        const auto render = render_statistics(*scene, *integrator_from(integrator), {4, 20000, 9});
        const double sigma[] = {0.01, 1.0, 4.0};
        for (std::size_t c = 0; c < 3; ++c) {
            const Estimate e = render.whole[render.layer("emission")][c];
            INFO("channel " << c << ": " << e.mean << " against " << 2.0 * std::exp(-sigma[c]));
            // 4 sigma of the estimate; the albedo is 0, so nothing else may arrive.
            CHECK(std::fabs(e.mean - 2.0 * std::exp(-sigma[c])) <
                  4.0 * std::sqrt(e.variance_of_mean) + 1e-5 * e.mean);
            CHECK(render.whole[render.layer("beauty")][c].mean == Approx(e.mean));
        }
    }
}

// One scattering of a point light in an unbounded-looking medium: the camera looks along +z through a large
// sphere of fog, the light stands off the axis. L = integral of sigma_s f_p I / d^2 exp(-sigma (t + d)) dt
// along the axis.
TEST_CASE("single scattering from a point light against quadrature", "[analytic][media]") {
    const double radius = 3.0, sigma_t = 0.7, albedo = 0.6, g = 0.4, intensity = 5.0;
    const double lx = 0.8, lz = 0.5;  // light at (lx, 0, lz); camera at the origin
    const int steps = 200000;
    double expected = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double t = (i + 0.5) / steps * radius;
        const double dx = lx, dz = lz - t, d = std::sqrt(dx * dx + dz * dz);
        // wo points back to the camera, wi to the light: forward scattering has dot(wo, wi) = -1.
        const double cosine = -dz / d;
        const double phase =
            (1.0 - g * g) / (4.0 * std::acos(-1.0) * std::pow(1.0 + g * g + 2.0 * g * cosine, 1.5));
        expected +=
            sigma_t * albedo * phase * intensity / (d * d) * std::exp(-sigma_t * (t + d)) * radius / steps;
    }
    const auto scene = scene_from(
        fmt::format(R"(<scene version="3.0.0">
        <emitter type="point"><point name="position" x="{}" y="0" z="{}"/><rgb name="intensity" value="{}"/></emitter>)",
                    lx, lz, intensity) +
            null_sphere(homogeneous(fmt::format("{}", sigma_t), fmt::format("{}", albedo), hg(g)), radius) +
            R"(<sensor type="orthographic"><float name="near_clip" value="1e-7"/><transform name="to_world"><scale value="1e-4"/></transform></sensor></scene>)",
        8);
    const std::string integrators[] = {
        R"(<integrator type="volpath"><integer name="max_depth" value="2"/></integrator>)",
        R"(<integrator type="volpath"><integer name="max_depth" value="2"/><boolean name="equiangular" value="true"/></integrator>)",
        R"(<integrator type="mote_vpl"><integer name="max_depth" value="2"/><integer name="paths" value="1"/></integrator>)"};
    for (const std::string& integrator : integrators) {
        INFO(integrator);
        const auto render = render_statistics(*scene, *integrator_from(integrator), {8, 4000, 11});
        check_mean_is(render, "single_scattering", expected, {1.02});
    }
}

// A grid of constant density is the homogeneous medium, layer by layer, for both integrators that see media.
TEST_CASE("a VDB of constant density equals the homogeneous medium", "[analytic][media][vdb]") {
    const GridFolder folder;
    const auto scene_with = [&](const std::string& medium) {
        return scene_from(
            R"(<scene version="3.0.0"><emitter type="point"><point name="position" x="1.5" y="3.2" z="1.5"/>
            <rgb name="intensity" value="9"/></emitter><shape type="cube"><transform name="to_world">
            <translate x="1.5" y="1.5" z="1.5"/></transform><bsdf type="null"/>)" +
                medium +
                R"(</shape><sensor type="perspective"><float name="fov" value="40"/><transform name="to_world">
            <lookat origin="1.5, 1.5, -3" target="1.5, 1.5, 1.5" up="0, 1, 0"/></transform></sensor></scene>)",
            8);
    };
    const auto constant =
        scene_with(R"(<medium type="heterogeneous" name="interior"><volume name="sigma_t" type="vdbvolume">
        <string name="filename" value=")" +
                   folder.grid("constant") + R"("/><transform name="to_world"><scale value="0.1"/>
        </transform></volume><volume name="albedo" type="constvolume"><rgb name="value" value="0.9, 0.7, 0.5"/></volume>
        <float name="scale" value="1.2"/></medium>)");
    const auto homogeneous_scene = scene_with(homogeneous("1.2", "0.9, 0.7, 0.5", ""));
    const std::string integrators[] = {
        R"(<integrator type="volpath"/>)",
        R"(<integrator type="mote_vpl"><integer name="paths" value="32"/><float name="bound" value="4"/></integrator>)"};
    for (const std::string& integrator : integrators) {
        const auto a = render_statistics(*constant, *integrator_from(integrator), {4, 3000, 31});
        const auto b = render_statistics(*homogeneous_scene, *integrator_from(integrator), {4, 3000, 32});
        const std::string suffix = integrator.find("vpl") != std::string::npos ? "_bounded" : "";
        for (const std::string& layer : {std::string("single_scattering"), "multiple_scattering" + suffix}) {
            INFO(integrator);
            check_same_mean(a, layer, b, layer, {1.12});
        }
    }
}
