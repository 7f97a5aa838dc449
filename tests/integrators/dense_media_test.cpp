// Media of extreme extinction beside others, and in front of all that the eye sees.
#include <fmt/format.h>

#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

/// Mean of all pixels in rows [first, last).
double mean(const Film& film, int first, int last) {
    const std::vector<Rgb> pixels = film.beauty();
    const std::size_t width = pixels.size() / 8;
    double sum = 0.0;
    for (std::size_t i = std::size_t(first) * width; i < std::size_t(last) * width; ++i)
        sum += double(average(pixels[i]));
    return sum / double(std::size_t(last - first) * width);
}

Film rendered(const Scene& scene, const std::string& integrator, std::uint64_t seed, std::uint32_t passes) {
    RenderRequest request;
    request.seed = seed, request.stop.passes = passes;
    return render(scene, *integrator_from(integrator), request).film;
}

/// A room of fog with a point light, and a ball of another medium at its floor.
std::unique_ptr<Scene> foggy_room(double extinction) {
    return scene_from(
        fmt::format(R"(<scene version="3.0.0"><sensor type="orthographic"><transform name="to_world">
        <scale x="2" y="2"/><lookat origin="0, 0, 6" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="cube"><transform name="to_world"><scale value="2"/></transform><bsdf type="null"/>
        <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="1.5"/><rgb name="albedo" value="0.7"/>
        </medium></shape>
        <shape type="sphere"><float name="radius" value="0.5"/><point name="center" x="-0.7" y="-1" z="0.6"/>
        <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="{}"/></medium></shape>
        <emitter type="point"><point name="position" x="-0.8" y="1" z="-0.8"/><rgb name="intensity" value="10"/>
        </emitter></scene>)",
                    extinction),
        8);
}

}  // namespace

// Ray lights of nanometres were sampled by the inverse root of their length, in place of all others: -60 %.
TEST_CASE("a ball of 1e18 optical depths takes no light from the fog around it, in ray lights",
          "[ray_lights][dense_media]") {
    const std::string lines =
        R"(<integrator type="mote_ray_lights"><integer name="paths" value="32"/></integrator>)";
    const auto dense = foggy_room(1e3), extreme = foggy_room(1e18);
    double sums[2] = {0.0, 0.0};
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        sums[0] += mean(rendered(*dense, lines, seed, 8), 0, 4);
        sums[1] += mean(rendered(*extreme, lines, seed, 8), 0, 4);
    }
    INFO(sums[0] << " " << sums[1]);
    // Light enters both balls by a hundredth of their radius at most.
    CHECK(sums[1] == Approx(sums[0]).epsilon(0.1));
}

// Behind 25 optical depths eye paths were followed by a chance of 5e-11, and pictures were black.
TEST_CASE("light behind a thick absorbing medium reaches mote_vpl where the eye sees nothing else",
          "[vpl][dense_media]") {
    const auto scene =
        scene_from(R"(<scene version="3.0.0"><sensor type="perspective"><transform name="to_world">
        <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform></sensor>
        <shape type="cube"><transform name="to_world"><scale x="9" y="9" z="0.5"/><translate z="2.5"/></transform>
        <bsdf type="null"/><medium type="homogeneous" name="interior"><rgb name="sigma_t" value="25"/>
        <rgb name="albedo" value="0"/></medium></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="9"/><translate z="-1"/></transform></shape>
        <emitter type="point"><point name="position" x="0" y="0" z="1"/></emitter></scene>)",
                   8);
    const double expected = mean(rendered(*scene, R"(<integrator type="volpath"/>)", 1, 64), 0, 8);
    REQUIRE(expected > 1e-13);
    const double found =
        mean(rendered(*scene, R"(<integrator type="mote_vpl"><integer name="paths" value="4"/></integrator>)",
                      1, 256),
             0, 8);
    // One path in 32 is followed: 512 of them, whose directions vary the transmittance by a factor of ten.
    CHECK(found == Approx(expected).epsilon(0.3));
}
