// `mote_vpl` with screen-space compensation: where the camera sees every surface that matters, the picture
// holds what exact compensation brings back; media can be compensated beside it; and what it cannot do is
// refused.
#include <algorithm>

#include "core/image/film.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
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

/// `interrupted`: after how many passes the film goes through a checkpoint, to a new estimator; 0: never.
Rendered render(const core::Scene& scene, const std::string& compensation, std::uint32_t passes,
                std::uint32_t interrupted = 0, std::uint64_t seed = 7) {
    const auto integrator = integrator_from(vpl(compensation));
    const int width = scene.film().width, height = scene.film().height;
    const auto layers = integrator->layers(scene);
    const core::RenderOptions options{seed, width, height, core::SamplerKind::sobol};
    auto estimator = integrator->prepare(scene, options);
    const auto filter = core::make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    core::Film film(width, height, layers);
    core::PassImage image(width, height, layers.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        if (pass > 0 && pass == interrupted) {
            estimator->finish(film);  // as a driver does for a preview
            const auto bytes = film.serialize();
            film = core::Film(width, height, layers);
            film.deserialize(bytes);
            estimator = integrator->prepare(scene, options);
        }
        image.clear();
        estimator->pass({pass, *filter, cancelled}, image);
        film.add_pass(image);
    }
    estimator->finish(film);
    Rendered result;
    for (std::size_t i = 0; i < layers.size(); ++i) result.layers[layers[i].name] = film.mean(i);
    return result;
}

std::string screen_space(int steps, int layers, int share = 1) {
    const auto number = [](const std::string& name, int value) {
        return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
    };
    return "<compensation type=\"screen_space\">" + number("steps", steps) + number("layers", layers) +
           number("hidden_share", share) + "</compensation>";
}

/// The corner behind a black board that hides the middle of it. It stands outside of the corner, where it is
/// in the way of no light.
std::string corner_with_board() {
    std::string xml = corner;
    xml.insert(xml.find("<emitter"),
               R"(<shape type="rectangle"><transform name="to_world"><scale value="0.4"/>
        <lookat origin="2.3, 2.2, 2.4" target="3.6, 2.9, 3.6" up="0, 1, 0"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf></shape>)");
    return xml;
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

TEST_CASE("screen-space compensation finds the even part of glossy surfaces, and never too much",
          "[compensation][ssbc]") {
    const auto with = [](const std::string& bsdf) {
        std::string xml = corner;
        for (std::size_t at; (at = xml.find("<bsdf type=\"diffuse\">")) != std::string::npos;)
            xml.replace(at, xml.find("</bsdf>", at) - at, "<bsdf type=" + bsdf);
        return scene_from(xml, 64);
    };
    const auto share = [](const core::Scene& scene) {
        const Rendered exact = render(scene, R"(<compensation type="exact"/>)", 40);
        const Rendered screen = render(
            scene, R"(<compensation type="screen_space"><integer name="steps" value="3"/></compensation>)",
            40);
        CHECK(exact.mean("compensation_surface") > 0.02 * exact.mean("indirect_bounded"));
        return screen.mean("compensation_surface") / exact.mean("compensation_surface");
    };
    const double plastic = share(*with(
        R"("roughplastic"><float name="alpha" value="0.2"/><rgb name="diffuse_reflectance" value="0.6"/>)"));
    const double metal = share(*with(R"("roughconductor"><float name="alpha" value="0.3"/>)"));
    INFO("plastic " << plastic << ", metal " << metal);
    CHECK((plastic > 0.3 && plastic < 1.0));  // the coat reflects some of it, and is left out: 0.60
    CHECK((metal >= 0.0 && metal < 0.01));    // its lobe is all it has
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

TEST_CASE("layers bring back what hidden walls send", "[compensation][ssbc][layers]") {
    const auto scene = scene_from(corner_with_board(), 96);
    const Rendered exact = render(*scene, R"(<compensation type="exact"/>)", 40);
    const Rendered one = render(*scene, screen_space(3, 1), 40), two = render(*scene, screen_space(3, 2), 40);
    const double taken = exact.mean("compensation_surface"),
                 with_one = one.mean("compensation_surface") / taken,
                 with_two = two.mean("compensation_surface") / taken;
    INFO("one layer " << with_one << ", two " << with_two);
    CHECK(with_one < 0.85);
    CHECK(with_two == Approx(1.0).epsilon(0.1));  // pixels along the border of the board are mixed
    // What is seen is rendered as before, and what is hidden is no part of the picture.
    CHECK(one.layers.at("indirect_bounded") == two.layers.at("indirect_bounded"));
    CHECK(two.mean("hidden_light_2") > 0.0);
    CHECK(two.mean("hidden_light_1_back") == 0.0);  // walls and board reflect on one side
    const auto layers = integrator_from(vpl(screen_space(3, 2)))->layers(*scene);
    CHECK(std::count_if(layers.begin(), layers.end(), [](const core::Layer& l) { return l.auxiliary; }) == 3);
}

TEST_CASE("light of hidden surfaces is that of seen ones", "[compensation][ssbc][layers]") {
    // Layer 2 where a board hides the corner, against layer 1 of the same corner without it: pixel centres
    // against means over pixels.
    const auto with = scene_from(corner_with_board(), 48), without = scene_from(corner, 48);
    const Rendered seen = render(*without, screen_space(3, 1), 30);
    const auto light_behind = [&](int share, std::uint64_t seed) {
        return render(*with, screen_space(3, 2, share), 30, 0, seed).layers.at("hidden_light_2");
    };
    const std::vector<core::Rgb> hidden = light_behind(1, 7);
    double behind = 0.0, all = 0.0, squares = 0.0;
    int compared = 0;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        const double light = double(core::average(hidden[i]));
        if (light == 0.0) continue;  // nothing is hidden, or what is sends no light that is seen
        const double expected =
            double(core::average(seen.layers.at("direct")[i] + seen.layers.at("indirect_bounded")[i]));
        behind += light, all += expected, squares += core::sqr(light / expected - 1.0), ++compared;
    }
    const double rms = std::sqrt(squares / compared);
    INFO(behind / all << " over " << compared << " pixels, rms " << rms);
    CHECK(compared > 50);
    CHECK(behind == Approx(all).epsilon(0.01));
    CHECK(rms < 0.05);
    // VPLs that are shared out make points noisy, and leave their mean as it is: by seeds, at 4 standard
    // errors.
    const int seeds = 40;
    double sum = 0.0, sum_of_squares = 0.0;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
        const auto few = light_behind(4, seed), many = light_behind(1, seed);
        double difference = 0.0;
        for (std::size_t i = 0; i < few.size(); ++i) difference += double(core::average(few[i] - many[i]));
        sum += difference / all, sum_of_squares += core::sqr(difference / all);
    }
    const double mean = sum / seeds, error = std::sqrt((sum_of_squares / seeds - mean * mean) / (seeds - 1));
    INFO("with shares " << mean << " +- " << error);
    CHECK(error > 0.0);
    CHECK(error < 0.01);
    CHECK(std::abs(mean) < 4.0 * error);
}

TEST_CASE("a checkpoint with layers resumes to the same bits", "[compensation][ssbc][layers][checkpoint]") {
    for (const std::string& medium : {std::string(), fog("0.3, 0.3, 0.3", "")}) {
        const auto scene = scene_from(box(grey, medium), 20);
        const Rendered straight = render(*scene, screen_space(2, 3, 4), 21),
                       resumed = render(*scene, screen_space(2, 3, 4), 21, 9);
        CHECK(straight.layers == resumed.layers);
        for (const char* side : {"hidden_light_2_back", "hidden_light_3"}) CHECK(straight.mean(side) > 0.0);
        // Planted: another number of passes would be seen.
        CHECK(straight.layers != render(*scene, screen_space(2, 3, 4), 20).layers);
    }
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
    CHECK_THAT(refusal(screen_space(2, 0)), Contains("layers"));
    CHECK_THAT(refusal(R"(<boolean name="bounded" value="false"/><compensation type="screen_space"/>)"),
               Contains("bounded"));
    CHECK(refusal(R"(<compensation type="screen_space"/>)") == "accepted");
}
