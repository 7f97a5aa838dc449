// The texture "volume": what a surface shows is what the grid holds there.
#include <filesystem>

#include "core/geometry/triangle_mesh.h"
#include "core/scene/emitter.h"
#include "media/vol_file.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// Linear in all three directions, so that trilinear interpolation has no error between the outermost
/// centres.
double value_at(const Vec3d& p) { return 0.1 + 0.3 * p.x + 0.2 * p.y + 0.25 * p.z; }

/// On the unit cube, as a file.
void write_grid(const std::string& path) {
    mote::media::VolFile grid;
    grid.resolution = {4, 5, 8}, grid.bounds = {Vec3(0.0f), Vec3(1.0f)};
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 4; ++x)
                grid.values.push_back(float(value_at((Vec3d(x, y, z) + 0.5) / Vec3d(grid.resolution))));
    mote::media::write_vol_file(path, grid);
}

/// A square of side 0.5 around (0.5, 0.5, 0.6), seen from in front, 8 x 8 pixels.
std::unique_ptr<Scene> square(const std::string& surface, const std::string& shape = "",
                              bool instanced = false) {
    static const TemporaryFolder folder;
    write_grid(folder.file("grid.vol"));
    const std::string volume =
        R"(<volume type="gridvolume" name="volume"><string name="filename" value="grid.vol"/></volume>)";
    const std::string place =
        R"(<transform name="to_world"><scale value="0.25"/><translate x="0.5" y="0.5" z="0.6"/></transform>)";
    std::string body = surface;
    body.replace(body.find("VOLUME"), 6, volume);
    const std::string inner =
        R"(<shape type="rectangle">)" + (instanced ? "" : place) + shape + body + "</shape>";
    return scene_from(R"(<scene version="3.0.0"><sensor type="orthographic"><transform name="to_world">
        <scale x="0.25" y="0.25"/><lookat origin="0.5, 0.5, 3" target="0.5, 0.5, 0" up="0, 1, 0"/></transform></sensor>)" +
                          (instanced ? R"(<shape type="instance">)" + place + R"(<shape type="shapegroup">)" +
                                           inner + "</shape></shape>"
                                     : inner) +
                          R"(<emitter type="constant"/></scene>)",
                      8, folder.path());
}

const std::string diffuse =
    R"(<bsdf type="diffuse"><texture type="volume" name="reflectance">VOLUME</texture></bsdf>)";

/// The mean of every pixel, against the value at its centre.
void check_picture(const Scene& scene, double offset) {
    const auto path =
        integrator_from(R"(<integrator type="path"><integer name="max_depth" value="2"/></integrator>)");
    const RenderStatistics r = render_statistics(scene, *path, {.block = 1, .passes = 64});
    const auto& pixels = r.blocks[r.layer("beauty")];
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const Estimate& e = pixels[std::size_t(y * 8 + x) * 3];
            const Vec3d center(0.25 + (x + 0.5) / 16.0, 0.75 - (y + 0.5) / 16.0, 0.6);
            CHECK(std::fabs(e.mean - offset - value_at(center)) < 5.0 * std::sqrt(e.variance_of_mean) + 1e-4);
        }
}

}  // namespace

TEST_CASE("a surface shows the grid's values at its points", "[volume_texture]") {
    check_picture(*square(diffuse), 0.0);
    check_picture(*square(diffuse, "", true), 0.0);  // where the instance stands, not the group
    check_picture(*square(R"(<bsdf type="mask"><float name="opacity" value="1"/><bsdf type="twosided">)" +
                          diffuse + "</bsdf></bsdf>"),
                  0.0);
}

TEST_CASE("a grid as opacity", "[volume_texture]") {
    const std::string holes = R"(<bsdf type="mask"><texture type="volume" name="opacity">VOLUME</texture>
        <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></bsdf>)";
    const auto path = integrator_from(R"(<integrator type="path"/>)");
    const auto scene = square(holes);
    const RenderStatistics r = render_statistics(*scene, *path, {.block = 8, .passes = 256});
    check_mean_is(r, "beauty", 1.0 - value_at({0.5, 0.5, 0.6}));
}

TEST_CASE("an area light with a grid: seen, connected to, and as a source", "[volume_texture]") {
    const auto scene =
        square(R"(<emitter type="area"><texture type="volume" name="radiance">VOLUME</texture></emitter>)",
               R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)");
    check_picture(*scene, 0.0);
    const Emitter& light = *scene->shapes()[0]->emitter;
    const Vec3 p(0.9f, 0.2f, 2.0f);
    for (int i = 0; i < 20; ++i) {
        const Vec2 u((float(i) + 0.5f) / 20.0f, float(i * 7 % 20) / 20.0f);
        const auto direct = light.sample_direct(p, u);
        REQUIRE(direct);
        const double met = value_at(Vec3d(p) + double(direct->distance) * Vec3d(direct->wi));
        CHECK(double(direct->weight.x) * double(direct->pdf_solid_angle) == Approx(met).epsilon(1e-4));
        const auto source = light.sample_emission(u, {0.3f, 0.6f});
        REQUIRE(source);
        CHECK(double(source->weight.x) * double(source->pdf_area) / M_PI ==
              Approx(value_at(Vec3d(source->origin))).epsilon(1e-4));
    }
}

TEST_CASE("a grid's largest value must be a reflectance", "[volume_texture]") {
    const TemporaryFolder folder;
    mote::media::VolFile grid;
    grid.resolution = {1, 1, 1}, grid.values = {1.5f}, grid.bounds = {Vec3(0.0f), Vec3(1.0f)};
    mote::media::write_vol_file(folder.file("bright.vol"), grid);
    try {
        scene_from(R"(<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>
            <shape type="sphere"><bsdf type="diffuse"><texture type="volume" name="reflectance"><volume type="gridvolume">
            <string name="filename" value="bright.vol"/></volume></texture></bsdf></shape></scene>)",
                   8, folder.path());
        FAIL("a reflectance of 1.5 was accepted");
    } catch (const InputError& error) {
        CHECK(std::string(error.what()).find("from 0.000000 to 1.500000") != std::string::npos);
    }
}
