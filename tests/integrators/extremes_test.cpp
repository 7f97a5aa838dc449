// Whole pictures of media at the extremes: furnaces from vacuum to lead, grids that no scanner made, scenes
// from a millimetre to a hundred kilometres, cameras and lights on boundaries and on each other.
// docs/methods/media.md has the table of what was tried and where it is tested.
#include <fmt/format.h>

#include <cmath>

#include "core/render/render_driver.h"
#include "media/vol_file.h"
#include "tests/integrators/test_scenes.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

const std::string volpath = R"(<integrator type="volpath"/>)";
const std::string equiangular =
    R"(<integrator type="volpath"><boolean name="equiangular" value="true"/></integrator>)";
const std::string guided =
    R"(<integrator type="volpath"><string name="guiding" value="on"/><integer name="guiding_passes" value="3"/>
    <integer name="guiding_paths" value="256"/>
    <float name="guiding_leaf_samples" value="200"/></integrator>)";
const std::string vpl = R"(<integrator type="mote_vpl"><integer name="paths" value="16"/></integrator>)";
const std::string unbounded_vpl =
    R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="-1"/></integrator>)";
const std::string photons =
    R"(<integrator type="mote_photon_map"><integer name="photon_paths" value="500"/></integrator>)";

/// A cube from -1 to 1 that holds the medium.
std::string cube_of(const std::string& medium) {
    return R"(<shape type="cube"><bsdf type="null"/>)" + medium + "</shape>";
}
std::string homogeneous(double sigma_t, double albedo, double g) {
    return fmt::format(R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="{}"/>
        <rgb name="albedo" value="{}"/><phase type="hg"><float name="g" value="{}"/></phase></medium>)",
                       sigma_t, albedo, g);
}
std::string camera(const std::string& origin, const std::string& target) {
    return fmt::format(
        R"(<sensor type="perspective"><float name="fov" value="30"/><float name="near_clip" value="1e-6"/><transform name="to_world">
        <lookat origin="{}" target="{}" up="0, 1, 0"/></transform></sensor>)",
        origin, target);
}
std::string scene_of(const std::string& content) {
    return R"(<scene version="3.0.0">)" + content + "</scene>";
}
const std::string white = R"(<emitter type="constant"/>)";

/// A medium whose extinction is this grid, fitted into the cube from -1 to 1.
std::string grid_medium(const std::string& path, const media::VolFile& file, double albedo,
                        const std::string& settings = "") {
    media::write_vol_file(path, file);
    return fmt::format(R"(<medium type="heterogeneous" name="interior">
        <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/>
        <transform name="to_world"><translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/></transform></volume>
        <rgb name="albedo" value="{}"/>{}</medium>)",
                       path, albedo, settings);
}

void check_furnace(const std::string& content, const std::string& name, std::uint32_t passes = 20) {
    const auto scene = scene_from(scene_of(white + content), 4);
    for (const std::string& integrator : {volpath, guided}) {
        const auto render = render_statistics(*scene, *integrator_from(integrator), {4, passes, 7});
        INFO(name << ", " << integrator);
        check_mean_is(render, "beauty", 1.0);
        CHECK(render.non_finite == 0);
    }
}

media::VolFile checkerboard() {
    return vol_grid(glm::ivec3(8), 1,
                    [](int x, int y, int z) { return core::Rgb((x + y + z) % 2 ? 1e4f : 0.0f); });
}
media::VolFile step_of_a_million() {
    return vol_grid(glm::ivec3(8), 1, [](int x, int, int) { return core::Rgb(x < 4 ? 1e-3f : 1e3f); });
}

}  // namespace

TEST_CASE("furnaces from vacuum to lead, forwards and backwards", "[media][extremes][furnace]") {
    for (const double depth : {1e-6, 1e-3, 1.0, 1e3, 1e6})
        for (const double g : {-0.999, 0.0, 0.999}) {
            if (depth > 1e4 && g > 0.0) continue;  // a thousand times as many events for the same way
            check_furnace(cube_of(homogeneous(depth / 2.0, 1.0, g)) + camera("0, 0, -4", "0, 0, 0"),
                          fmt::format("optical depth {}, g {}", depth, g), 40);
        }
}

TEST_CASE("furnaces of a checkerboard and of a step of a million to one", "[media][extremes][furnace]") {
    const TemporaryFolder folder;
    const auto file = folder.file("grid.vol");
    check_furnace(cube_of(grid_medium(file, checkerboard(), 1.0)) + camera("0.1, 0.3, -4", "0, 0, 0"),
                  "checkerboard", 40);
    check_furnace(cube_of(grid_medium(file, step_of_a_million(), 1.0)) + camera("0.1, 0.3, -4", "0, 0, 0"),
                  "step", 40);
}

TEST_CASE("grids without density, of one voxel, and of steps render finite pictures", "[media][extremes]") {
    const TemporaryFolder folder;
    const auto file = folder.file("grid.vol");
    const media::VolFile grids[] = {vol_grid(glm::ivec3(4), 1, [](int, int, int) { return core::Rgb(0.0f); }),
                                    vol_grid(glm::ivec3(1), 1, [](int, int, int) { return core::Rgb(2.0f); }),
                                    checkerboard(), step_of_a_million()};
    for (const media::VolFile& grid : grids)
        for (const double albedo : {0.0, 1.0})
            for (const std::string& integrator : {volpath, guided, vpl, photons}) {
                const auto scene = scene_from(box(grey, grid_medium(file, grid, albedo)), 4);
                const auto render = render_statistics(*scene, *integrator_from(integrator), {4, 2, 3});
                INFO(integrator << ", albedo " << albedo);
                CHECK(render.non_finite == 0);
                if (albedo == 0.0) CHECK(render.whole[render.layer("single_scattering")][1].mean == 0.0);
            }
}

TEST_CASE("one voxel of 1e37 among 0.1 costs no method more than what rays cross",
          "[media][extremes][regular]") {
    const TemporaryFolder folder;
    const std::string light =
        R"(<emitter type="point"><point name="position" x="-0.9" y="0.7" z="-0.8"/></emitter>)";
    const std::string maps =
        R"(<visibility type="shadow_map"><integer name="size" value="16"/></visibility>)";
    const std::string light_maps =
        R"(<visibility type="shadow_map"><integer name="light_size" value="16"/></visibility>)";
    const auto of = [](const std::string& type, const std::string& content) {
        return "<integrator type=\"" + type + "\">" + content + "</integrator>";
    };
    const std::string paths = R"(<integer name="paths" value="16"/>)";
    std::uint64_t least = 0;
    for (const float hot : {1e3f, 1e37f}) {
        const auto scene =
            scene_from(scene_of(light + camera("0.1, 0.2, -4", "0, 0, 0") +
                                cube_of(grid_medium(folder.file("hot.vol"), hot_grid(1, hot), 0.9))),
                       8);
        std::uint64_t lookups = 0;
        for (const std::string& integrator :
             {volpath, equiangular, vpl, unbounded_vpl, photons, of("mote_vpl", paths + maps),
              of("mote_single_scattering", ""), of("mote_single_scattering", light_maps),
              of("mote_epipolar", ""), of("mote_epipolar", light_maps)}) {
            INFO(integrator << ", " << hot);
            core::RenderRequest request;
            request.stop.passes = 4;
            const auto statistics = core::render(*scene, *integrator_from(integrator), request).statistics;
            CHECK(statistics.non_finite_samples == 0);
            CHECK(statistics.lookups.at("step_limit_fallbacks") == 0);
            lookups += statistics.lookups.at("density");
        }
        if (least == 0) least = lookups;
        CHECK(lookups < 2 * least);
    }
    check_furnace(cube_of(grid_medium(folder.file("hot.vol"), hot_grid(1, 1e37f), 1.0)) +
                      camera("0, 0.1, -4", "0, 0, 0"),
                  "furnace of hot voxels", 10);
}

TEST_CASE("a grid without density is no medium", "[media][extremes]") {
    const TemporaryFolder folder;
    const auto empty = vol_grid(glm::ivec3(4), 1, [](int, int, int) { return core::Rgb(0.0f); });
    const auto with = scene_from(box(grey, grid_medium(folder.file("empty.vol"), empty, 0.9)), 8);
    const auto without = scene_from(box(grey, ""), 8);
    for (const std::string& integrator : {volpath, guided, vpl}) {
        const auto a = render_statistics(*with, *integrator_from(integrator), {4, 200, 3});
        const auto b = render_statistics(*without, *integrator_from(integrator), {4, 200, 4});
        INFO(integrator);
        check_same_mean(a, "beauty", b, "beauty");
        CHECK(a.whole[a.layer("single_scattering")][0].mean == 0.0);
    }
}

TEST_CASE("a camera exactly on the boundary of a medium sees what lies ahead of it", "[media][extremes]") {
    const double sigma = 0.8;
    const struct {
        const char *name, *origin, *target;
        double length;  ///< through the medium
    } views[] = {{"inwards", "0, 0, -1", "0, 0, 1", 2.0},
                 {"outwards", "0, 0, -1", "0, 0, -3", 0.0},
                 {"inwards from an edge", "0, -1, -1", "0, 1, 1", 2.0 * std::sqrt(2.0)},
                 {"inwards at x", "1, 0.2, 0.1", "-1, 0.2, 0.1", 2.0},
                 {"outwards at x", "1, 0.2, 0.1", "3, 0.2, 0.1", 0.0}};
    for (const auto& view : views) {
        // So narrow that all pixels see the same length: from an edge it changes with the angle itself.
        const auto scene = scene_from(
            scene_of(
                white + cube_of(homogeneous(sigma, 0.0, 0.0)) +
                fmt::format(
                    R"(<sensor type="perspective"><float name="fov" value="0.0001"/><float name="near_clip" value="1e-6"/>
            <transform name="to_world"><lookat origin="{}" target="{}" up="0, 0.8, 0.6"/></transform></sensor>)",
                    view.origin, view.target)),
            4);
        const auto render = render_statistics(*scene, *integrator_from(volpath), {4, 4000, 5});
        INFO(view.name);
        check_mean_is(render, "beauty", std::exp(-sigma * view.length));
    }
    // In equilibrium nothing can be seen, wherever the camera stands and looks: along the face, too.
    for (const char* target : {"0, 0, 1", "0, 0, -3", "1, 0, -1", "0.3, 0.9, -1"})
        check_furnace(cube_of(homogeneous(2.0, 1.0, 0.5)) + camera("0, 0, -1", target),
                      std::string("furnace from the face towards ") + target);
}

TEST_CASE("a light in the medium at the camera, and cameras between media, stay finite",
          "[media][extremes]") {
    const std::string lights[] = {
        R"(<emitter type="point"><point name="position" x="0.1" y="0.2" z="-0.3"/></emitter>)",
        R"(<emitter type="spot"><transform name="to_world"><lookat origin="0.1, 0.2, -0.3" target="0, 0, 1"
            up="0, 1, 0"/></transform></emitter>)",
        R"(<shape type="sphere"><point name="center" x="0.1" y="0.2" z="-0.3"/><float name="radius" value="0.01"/>
            <boolean name="flip_normals" value="true"/><emitter type="area"/></shape>)"};
    for (const std::string& light : lights)
        for (const std::string& integrator : {volpath, equiangular, guided, vpl, unbounded_vpl, photons}) {
            const auto scene = scene_from(
                scene_of(light + cube_of(homogeneous(1.5, 0.9, 0.3)) + camera("0.1, 0.2, -0.3", "0, 0, 1")),
                4);
            const auto render = render_statistics(*scene, *integrator_from(integrator), {4, 50, 3});
            INFO(light << "\n" << integrator);
            CHECK(render.non_finite == 0);
            CHECK(std::isfinite(render.whole.back()[0].mean));
        }
}

TEST_CASE("virtual point lights on their receivers and on the eye ray stay finite", "[media][extremes]") {
    // A thread of light along the camera's axis: every light path is the eye path.
    const std::string thread =
        R"(<emitter type="spot"><float name="cutoff_angle" value="0.05"/><transform name="to_world">
        <lookat origin="0, 0, -3" target="0, 0, 0" up="0, 1, 0"/></transform></emitter>)";
    const std::string wall = R"(<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="180"/>
        </transform><bsdf type="diffuse"/></shape>)";
    const std::string eye =
        R"(<sensor type="orthographic"><transform name="to_world"><scale x="1e-6" y="1e-6"/>
        <lookat origin="0, 0, -3" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)";
    for (const std::string& medium : {std::string(), cube_of(homogeneous(1.0, 0.9, 0.9))})
        for (const std::string& integrator : {vpl, unbounded_vpl, photons}) {
            const auto scene = scene_from(scene_of(thread + wall + medium + eye), 4);
            const auto render = render_statistics(*scene, *integrator_from(integrator), {4, 50, 3});
            INFO(integrator << "\n" << medium);
            CHECK(render.non_finite == 0);
            CHECK(std::isfinite(render.whole.back()[0].mean));
            CHECK(render.whole.back()[0].mean > 0.0);
        }
}

namespace {

/// A small foggy room with a lamp and a point light, all lengths times `s`, coefficients by 1 / s.
std::unique_ptr<core::Scene> scaled_room(double s, const std::string& smoke) {
    const auto shape = [&](const std::string& type, const std::string& transform, const std::string& rest) {
        return fmt::format(
            R"(<shape type="{}"><transform name="to_world">{}<scale value="{:.17g}"/></transform>{}</shape>)",
            type, transform, s, rest);
    };
    std::string xml = shape("rectangle", R"(<translate z="-1"/>)", grey);
    xml += shape("rectangle", R"(<translate z="-1"/><rotate x="1" angle="-90"/>)", glossy);
    xml += shape("rectangle", R"(<scale value="0.3"/><rotate x="1" angle="90"/><translate y="0.95"/>)",
                 R"(<emitter type="area"><rgb name="radiance" value="8, 6, 4"/></emitter>)");
    xml += fmt::format(R"(<emitter type="point"><rgb name="intensity" value="{:.17g}"/>
        <point name="position" x="{:.17g}" y="{:.17g}" z="{:.17g}"/></emitter>)",
                       s * s, 0.6 * s, 0.3 * s, 0.5 * s);
    const std::string medium =
        smoke.empty()
            ? fmt::format(R"(<medium type="homogeneous" name="interior"><float name="scale" value="{:.17g}"/>
            <rgb name="sigma_t" value="0.5, 0.8, 1.2"/><rgb name="albedo" value="0.9"/></medium>)",
                          1.0 / s)
            : fmt::format(
                  R"(<medium type="heterogeneous" name="interior"><float name="scale" value="{:.17g}"/>
            <volume name="sigma_t" type="gridvolume"><string name="filename" value="{}"/><transform name="to_world">
            <translate x="-0.5" y="-0.5" z="-0.5"/><scale value="2"/><scale value="{:.17g}"/></transform></volume>
            <rgb name="albedo" value="0.9"/></medium>)",
                  1.0 / s, smoke, s);
    xml += shape("cube", R"(<scale value="0.9"/>)", R"(<bsdf type="null"/>)" + medium);
    xml += fmt::format(R"(<sensor type="perspective"><float name="fov" value="40"/>
        <float name="near_clip" value="{:.17g}"/><float name="far_clip" value="{:.17g}"/>
        <transform name="to_world"><lookat origin="0, 0, {:.17g}" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>)",
                       0.01 * s, 100.0 * s, 3.6 * s);
    return scene_from(scene_of(xml), 8);
}

}  // namespace

TEST_CASE("the picture does not depend on the unit of length", "[media][extremes][scale]") {
    const TemporaryFolder folder;
    const auto smoke = folder.file("smoke.vol");
    media::write_vol_file(smoke, random_grid(glm::ivec3(12), 1, 5));
    for (const std::string& grid : {std::string(), smoke})
        for (const std::string& integrator : {volpath, guided, vpl, photons}) {
            const bool paths = integrator == volpath || integrator == guided;
            const std::uint32_t passes = paths ? 800 : integrator == vpl ? 80 : 40;
            const auto picture = [&](double scale, std::uint64_t seed) {
                return render_statistics(*scaled_room(scale, grid), *integrator_from(integrator),
                                         {4, passes, seed});
            };
            INFO((grid.empty() ? "fog, " : "smoke, ") << integrator);
            // Powers of two change no digit of any number: with the same seed the same picture, but for rays
            // that just miss.
            const auto reference = picture(1.0, 3);
            for (const double scale : {0x1p-10, 0x1p17}) {
                const auto scaled = picture(scale, 3);
                INFO("lengths times " << scale);
                for (int c = 0; c < 3; ++c)
                    CHECK(scaled.whole.back()[std::size_t(c)].mean ==
                          Approx(reference.whole.back()[std::size_t(c)].mean).epsilon(1e-3));
            }
            for (const double scale : {1e-3, 1e5}) {
                INFO("lengths times " << scale);
                check_same_mean(picture(scale, 4), "beauty", reference, "beauty");
            }
            CHECK_FALSE(same_mean(picture(1.0, 4).scaled(1.5), "beauty", reference, "beauty").passed);
        }
}
