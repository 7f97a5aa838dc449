// `mote_vpl` with screen-space compensation: where the camera sees every surface that matters, the picture
// holds what exact compensation brings back; media can be compensated beside it; and what it cannot do is
// refused.
#include "core/image/film.h"
#include "core/render/render_driver.h"
#include "core/scene/error.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// Two walls and a floor that meet in a corner, all in view.
const std::string corner = R"(<scene version="3.0.0">
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><translate x="1" z="1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.6, 0.5"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><translate x="1" y="1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/><translate y="1" z="1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.6, 0.7"/></bsdf></shape>
    <emitter type="point"><point name="position" x="1.1" y="1.2" z="1.0"/><rgb name="intensity" value="2"/></emitter>
    <sensor type="perspective"><float name="fov" value="48"/><transform name="to_world">
        <lookat origin="3.6, 2.9, 3.6" target="0.75, 0.7, 0.75" up="0, 1, 0"/></transform></sensor></scene>)";

std::string vpl(const std::string& compensation) {
    return R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="3"/>)" +
           compensation + "</integrator>";
}

struct Rendered {
    std::map<std::string, std::vector<core::Rgb>> layers;
    double mean(const std::string& layer) const {
        double sum = 0.0;
        for (const core::Rgb& v : layers.at(layer)) sum += double(core::average(v));
        return sum / double(layers.at(layer).size());
    }
};

Rendered render(const core::Scene& scene, const std::string& compensation, std::uint32_t passes) {
    const auto integrator = integrator_from(vpl(compensation));
    const int width = scene.film().width, height = scene.film().height;
    const auto layers = integrator->layers(scene);
    const auto estimator = integrator->prepare(scene, {7, width, height, core::SamplerKind::sobol});
    const auto filter = core::make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    core::Film film(width, height, layers);
    core::PassImage image(width, height, layers.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        image.clear();
        estimator->pass({pass, *filter, cancelled}, image);
        film.add_pass(image);
    }
    estimator->finish(film);
    Rendered result;
    for (std::size_t i = 0; i < layers.size(); ++i) result.layers[layers[i].name] = film.mean(i);
    return result;
}

std::string refusal(const std::string& compensation) {
    try {
        integrator_from(vpl(compensation));
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("screen-space compensation brings back what exact compensation does in a corner",
          "[compensation][ssbc]") {
    const auto scene = scene_from(corner, 96);
    const Rendered exact = render(*scene, R"(<compensation type="exact"/>)", 40);
    const Rendered screen = render(
        *scene, R"(<compensation type="screen_space"><integer name="steps" value="3"/></compensation>)", 40);
    CHECK(screen.layers.at("indirect_bounded") == exact.layers.at("indirect_bounded"));
    const double taken = exact.mean("compensation_surface");
    INFO(screen.mean("compensation_surface") << " of " << taken);
    CHECK(taken > 0.05 * exact.mean("indirect_bounded"));
    // Pixels at the border and the finite pixels of the edges cost a few per cent; noise of 150 passes is
    // below that.
    CHECK(screen.mean("compensation_surface") == Approx(taken).epsilon(0.08));
    // One step alone lacks what a second one adds.
    const Rendered one = render(
        *scene, R"(<compensation type="screen_space"><integer name="steps" value="1"/></compensation>)", 40);
    CHECK(one.mean("compensation_surface") < 0.97 * screen.mean("compensation_surface"));
}

TEST_CASE("screen-space compensation on surfaces, another in media", "[compensation][ssbc]") {
    const auto scene = scene_from(box(grey, fog("1, 1, 1", "")), 16);
    const Rendered both = render(*scene, R"(<compensation type="screen_space">
        <compensation name="media" type="exact"/></compensation>)",
                                 40);
    CHECK(both.mean("compensation_surface") > 0.0);
    CHECK(both.mean("compensation_volume") > 0.0);
    const Rendered alone = render(*scene, R"(<compensation type="screen_space"/>)", 40);
    CHECK(alone.mean("compensation_volume") == 0.0);
    // The medium's part is that of the same compensation without screen space.
    const Rendered exact = render(
        *scene, R"(<compensation type="exact"><string name="receivers" value="media"/></compensation>)", 40);
    CHECK(exact.layers.at("compensation_volume") == both.layers.at("compensation_volume"));
    CHECK(exact.mean("compensation_surface") == 0.0);
}

TEST_CASE("screen-space compensation of media is refused by name", "[compensation][ssbc]") {
    using Catch::Matchers::Contains;
    CHECK_THAT(
        refusal(
            R"(<compensation type="screen_space"><string name="receivers" value="media"/></compensation>)"),
        Contains("surfaces alone") && Contains("'media'"));
    CHECK_THAT(
        refusal(R"(<compensation type="screen_space"><integer name="steps" value="0"/></compensation>)"),
        Contains("steps"));
    CHECK_THAT(refusal(R"(<boolean name="bounded" value="false"/><compensation type="screen_space"/>)"),
               Contains("bounded"));
    CHECK(refusal(R"(<compensation type="screen_space"/>)") == "accepted");
}
