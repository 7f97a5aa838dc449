// A room thousands of its sizes from the origin of coordinates has the light that it has at the origin, by
// every integrator that is registered.
#include <fmt/format.h>

#include <cmath>

#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// A closed room of 4 m with a block, a ball and a lamp below its ceiling, turned so that no plane is exact
/// in single precision.
const std::string turned = R"(<rotate x="0.3" y="1" z="0.2" angle="17"/>)";
std::string room(double x, double y, double z) {
    const std::string place =
        turned + fmt::format(R"(<translate x="{}" y="{}" z="{}"/></transform>)", x, y, z);
    const auto shape = [&](const std::string& type, const std::string& transform, const std::string& rest) {
        return fmt::format(R"(<shape type="{}"><transform name="to_world">{}{}{}</shape>)", type, transform,
                           place, rest);
    };
    std::string xml;
    for (const char* turn : {"", R"(<rotate x="1" angle="-90"/>)", R"(<rotate x="1" angle="90"/>)",
                             R"(<rotate x="1" angle="180"/>)", R"(<rotate y="1" angle="90"/>)",
                             R"(<rotate y="1" angle="-90"/>)"})
        xml += shape("rectangle", std::string(R"(<scale value="2"/><translate z="-2"/>)") + turn, grey);
    xml += shape("cube", R"(<scale value="0.5"/><translate x="0.75" y="-1.5" z="-0.5"/>)", grey);
    xml += shape("sphere", R"(<scale value="0.5"/><translate x="-0.75" y="-1" z="0.25"/>)", mixed);
    xml += shape("rectangle", R"(<scale value="0.5"/><rotate x="1" angle="90"/><translate y="1.75"/>)",
                 R"(<emitter type="area"><rgb name="radiance" value="10, 8, 6"/></emitter>)");
    return R"(<scene version="3.0.0">)" + xml +
           fmt::format(R"(<sensor type="perspective"><float name="fov" value="60"/><transform name="to_world">
           <lookat origin="0, 0, 1.9" target="0, 0, 0" up="0, 1, 0"/>{}</sensor></scene>)",
                       place);
}

/// Means of a picture of each seed.
std::vector<double> means(const core::Scene& scene, const core::Integrator& integrator, int seeds) {
    std::vector<double> result;
    for (int seed = 1; seed <= seeds; ++seed) {
        core::RenderRequest request;
        request.seed = std::uint64_t(seed), request.stop.passes = 4;
        const core::Film film = core::render(scene, integrator, request).film;
        double sum = 0.0;
        for (const core::Rgb& pixel : film.beauty()) sum += double(core::average(pixel));
        result.push_back(sum / double(film.beauty().size()));
    }
    return result;
}

}  // namespace

TEST_CASE("a room twelve kilometres from the origin has the light that it has there, in every integrator",
          "[scale][shadow]") {
    constexpr int seeds = 16;
    const auto near = scene_from(room(0, 0, 0), 8), far = scene_from(room(10000, 7000, -4000), 8);
    std::vector<std::string> all;
    for (const std::string& type : registry().types(core::Category::integrator))
        // Rounding cuts the ball into more charts than an atlas of 400 texels holds.
        all.push_back(fmt::format(R"(<integrator type="{}">{}</integrator>)", type,
                                  type == "mote_ray_bundles" ? R"(<integer name="directions" value="32"/>
                                        <integer name="texel_budget" value="8000"/>)"
                                                             : quick_settings(type)));
    all.push_back(R"(<integrator type="mote_vpl"><integer name="paths" value="40"/>
        <selection name="selection" type="resampling"/></integrator>)");
    for (const std::string& xml : all) {
        INFO(xml);
        const auto integrator = integrator_from(xml);
        const auto a = means(*near, *integrator, seeds), b = means(*far, *integrator, seeds);
        double mean = 0.0, difference = 0.0, squares = 0.0;
        for (int i = 0; i < seeds; ++i)
            mean += a[i] / seeds, difference += (b[i] - a[i]) / seeds,
                squares += (b[i] - a[i]) * (b[i] - a[i]);
        const double error = std::sqrt((squares / seeds - difference * difference) / (seeds - 1));
        INFO(difference / mean << " +- " << error / mean);
        // Pairs of one seed: most random numbers lead to the same paths. Half a percent is what rounding to
        // a millimetre takes from a room of 4 m.
        CHECK(std::fabs(difference) < 0.005 * mean + 5.0 * error);
        CHECK(error < 0.02 * mean);
    }
}
