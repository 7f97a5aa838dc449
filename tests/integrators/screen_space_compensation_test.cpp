// `mote_vpl` with screen-space compensation: where the camera sees every surface that matters, the picture
// holds what exact compensation brings back; media can be compensated beside it; and what it cannot do is
// refused.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/film/film.h"
#include "core/math/frame.h"
#include "core/objects/error.h"
#include "core/render/render_driver.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/grid_convergence.h"
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

std::string vpl(const std::string& compensation, double bound = 3.0) {
    return fmt::format(
        R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="{}"/>
        {}</integrator>)",
        bound, compensation);
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
                std::uint32_t interrupted = 0, std::uint64_t seed = 7, double bound = 3.0) {
    const auto integrator = integrator_from(vpl(compensation, bound));
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
            estimator->finish(film, {});  // as a driver does for a preview
            const auto bytes = film.serialize();
            film = core::Film(width, height, layers);
            film.deserialize(bytes);
            estimator = integrator->prepare(scene, options);
        }
        image.clear();
        estimator->pass({pass, *filter, cancelled}, image);
        film.add_pass(image);
    }
    estimator->finish(film, {});
    Rendered result;
    for (std::size_t i = 0; i < layers.size(); ++i) result.layers[layers[i].name] = film.mean(i);
    return result;
}

std::string screen_space(int steps, int layers, int stride = 1) {
    const auto number = [](const std::string& name, int value) {
        return "<integer name=\"" + name + "\" value=\"" + std::to_string(value) + "\"/>";
    };
    return "<compensation type=\"screen_space\">" + number("steps", steps) + number("layers", layers) +
           number("hidden_share", stride) + "</compensation>";
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

std::string refusal(const std::string& compensation, double bound = 3.0) {
    try {
        integrator_from(vpl(compensation, bound));
    } catch (const core::InputError& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

namespace {

/// The corner from farther away, with both ends of every wall in view.
std::string whole_corner() {
    std::string xml = corner;
    const std::string near = R"(origin="3.6, 2.9, 3.6" target="0.75, 0.7, 0.75")", fov = R"(value="48")";
    xml.replace(xml.find(near), near.size(), R"(origin="6, 6, 6" target="0.75, 0.65, 0.75")");
    return xml.replace(xml.find(fov), fov.size(), R"(value="30")");
}

struct Fraction {
    double value, error;  ///< standard error over seeds
};

/// How much of exact compensation the picture finds.
Fraction found_fraction(const core::Scene& scene, const std::string& screen, int seeds,
                        std::uint32_t passes) {
    std::vector<double> found, right;
    double sum = 0.0, all = 0.0;
    for (int seed = 1; seed <= seeds; ++seed) {
        const auto mean = [&](const std::string& compensation) {
            return render(scene, compensation, passes, 0, std::uint64_t(seed)).mean("compensation_surface");
        };
        found.push_back(mean(screen)), right.push_back(mean(R"(<compensation type="exact"/>)"));
        sum += found.back(), all += right.back();
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) squares += core::sqr(found[i] - sum / all * right[i]);
    return {sum / all, std::sqrt(squares * seeds / (seeds - 1)) / all};
}

}  // namespace

TEST_CASE("screen-space compensation brings back what exact compensation does in a corner",
          "[compensation][ssbc]") {
    // All is in view, and after eight steps less than (0.7 / 2)^8 = 2e-4 of the light is missing: T_r
    // multiplies by the reflectance times form factors, which are 1/2 at an edge at most. What is left is
    // noise and the size of the pixels.
    const auto screen = [](int steps) {
        return fmt::format(
            R"(<compensation type="screen_space"><integer name="steps" value="{}"/></compensation>)", steps);
    };
    std::array<double, 3> fraction{};
    double error = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Fraction s = found_fraction(*scene_from(whole_corner(), 40 << k), screen(8), 6, 40u >> k);
        fraction[k] = s.value, error = s.error;
    }
    // Compensation is largest beside edges, where the order in the pixels' size is 2/3 (ssbc_exact_test.cpp).
    const double tolerance = grid_convergence_index(fraction, 2.0 / 3.0, 1.0) + 4.0 * error;
    INFO(fraction[0] << ", " << fraction[1] << ", " << fraction[2] << " +- " << error << ", tolerance "
                     << tolerance);
    CHECK(tolerance < 0.1);
    CHECK(std::abs(fraction[2] - 1.0) < tolerance);
    CHECK(std::abs(0.85 * fraction[2] - 1.0) > tolerance);  // planted
    CHECK(std::abs(1.15 * fraction[2] - 1.0) > tolerance);

    // The picture is the same but for the compensation, which every step adds to.
    const auto scene = scene_from(whole_corner(), 40);
    const Rendered exact = render(*scene, R"(<compensation type="exact"/>)", 4);
    CHECK(exact.mean("compensation_surface") > 0.05 * exact.mean("indirect_bounded"));
    double before = 0.0;
    for (int steps = 1; steps <= 3; ++steps) {
        const Rendered some = render(*scene, screen(steps), 4);
        CHECK(some.layers.at("indirect_bounded") == exact.layers.at("indirect_bounded"));
        CHECK(some.mean("compensation_surface") > before);
        before = some.mean("compensation_surface");
    }
}

namespace {

/// The corner with another BSDF on all of it, or on the floor alone.
std::unique_ptr<core::Scene> corner_with(const std::string& bsdf, bool floor_alone) {
    std::string xml = corner;
    std::size_t at = 0;
    while ((at = xml.find("<bsdf type=\"diffuse\">", at)) != std::string::npos) {
        xml.replace(at, xml.find("</bsdf>", at) - at, "<bsdf type=" + bsdf);
        if (floor_alone) break;
        at += bsdf.size();
    }
    return scene_from(xml, 64);
}
const std::string plastic =
    R"("roughplastic"><float name="alpha" value="0.2"/><rgb name="diffuse_reflectance" value="0.6"/>)";
const std::string metal = R"("roughconductor"><float name="alpha" value="0.3"/>)";

/// pi times the least of the BSDF over all directions within 45 degrees of the normal.
double even_part(const core::Bsdf& bsdf, const core::Vec3& wo) {
    double least = 1.0;
    for (int i = 0; i <= 30; ++i)
        for (int j = 0; j < 72; ++j) {
            const double theta = 0.25 * double(core::pi) * i / 30.0, phi = 2.0 * double(core::pi) * j / 72.0;
            const core::Vec3 wi(core::Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                            std::cos(theta)));
            const core::Rgb f = bsdf.eval({}, wo, wi, core::TransportMode::radiance);
            least = std::min(least, double(core::pi) * double(f.x));
        }
    return least;
}

}  // namespace

TEST_CASE("screen-space compensation finds the even part of glossy surfaces", "[compensation][ssbc]") {
    // With next to no bound the picture before compensation is direct light. The walls send the same to a
    // floor of whatever BSDF, and of that light one step reflects what the floor reflects evenly.
    const std::string one_step =
        R"(<compensation type="screen_space"><integer name="steps" value="1"/></compensation>)";
    const double reflectance = 0.5, bound = 1e-6;
    const auto layer = [&](const core::Scene& scene) {
        return render(scene, one_step, 1, 0, 7, bound).layers.at("compensation_surface");
    };
    const auto diffuse = layer(*corner_with(R"("diffuse"><rgb name="reflectance" value="0.5"/>)", true));
    const auto found_on_floor = [&](const std::string& bsdf) {
        struct {
            double found = 0.0, even = 0.0, with_albedo = 0.0, diffuse = 0.0;
        } sum;
        const auto scene = corner_with(bsdf, true);
        const auto found = layer(*scene);
        const auto buffer = screenspace::make_g_buffer(*scene, scene->camera(), 64, 64);
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (!buffer.hit[i] || buffer.shading_normal[i].y < 0.99f) continue;
            const core::Vec3 wo = core::Frame(buffer.shading_normal[i]).to_local(-buffer.view[i]);
            const double white = double(diffuse[i].x) / reflectance;
            sum.found += double(found[i].x), sum.diffuse += double(diffuse[i].x);
            sum.even += white * even_part(*buffer.shape[i]->bsdf, wo);
            sum.with_albedo += white * double(buffer.reflectance[i].x);
        }
        CHECK(sum.diffuse > 0.0);
        return sum;
    };
    const auto on_plastic = found_on_floor(plastic), on_metal = found_on_floor(metal);
    // The library looks along five directions; what the lobe adds elsewhere is below 1 %.
    CHECK(on_plastic.found == Approx(on_plastic.even).epsilon(0.01));
    CHECK(on_plastic.with_albedo > 1.05 * on_plastic.even);  // an albedo instead would be seen
    CHECK(on_metal.found >= on_metal.even);
    CHECK(on_metal.found < 0.01 * on_metal.diffuse);  // its lobe is all it has
}

TEST_CASE("screen-space compensation never finds too much on glossy surfaces", "[compensation][ssbc]") {
    for (const std::string& bsdf : {plastic, metal}) {
        const Fraction fraction = found_fraction(*corner_with(bsdf, false), screen_space(3, 1), 4, 8);
        INFO(bsdf << ": " << fraction.value << " +- " << fraction.error);
        CHECK(fraction.value > 0.0);
        CHECK(fraction.value + 4.0 * fraction.error < 1.0);  // the lobe is missing
    }
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
    // The board is black and in the way of no light: where it is not seen, the picture is that of the corner
    // without it, and so has to be its compensation, except for the pixels along the border of the board.
    const auto scene = scene_from(corner_with_board(), 96), open = scene_from(corner, 96);
    const Rendered one = render(*scene, screen_space(3, 1), 10), two = render(*scene, screen_space(3, 2), 10),
                   whole = render(*open, screen_space(3, 1), 10);
    const auto buffer = screenspace::make_g_buffer(*scene, scene->camera(), 96, 96),
               behind = screenspace::make_g_buffer(*open, open->camera(), 96, 96);
    const auto board = [&](std::size_t i) { return buffer.distance[i] != behind.distance[i]; };
    double with_one = 0.0, with_two = 0.0, all = 0.0;
    int hidden = 0, border = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
            const std::size_t i = buffer.index(x, y);
            hidden += board(i);
            border += (x > 0 && board(i) != board(i - 1)) || (y > 0 && board(i) != board(i - 96));
            if (board(i)) continue;
            const auto at = [&](const Rendered& r) {
                return double(r.layers.at("compensation_surface")[i].x);
            };
            with_one += at(one), with_two += at(two), all += at(whole);
        }
    // Fraction of mixed pixels: as much of the light of hidden walls may be wrong.
    const double missing = 1.0 - with_one / all, tolerance = missing * border / hidden;
    INFO("without the second layer " << missing << " is missing, with it " << 1.0 - with_two / all
                                     << ", tolerance " << tolerance);
    CHECK(hidden > 1000);
    CHECK(missing > 0.1);
    CHECK(std::abs(with_two / all - 1.0) < tolerance);
    CHECK(tolerance < 0.2 * missing);
    // Seen surfaces are rendered as before, and hidden ones are no part of the image.
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
    const auto light_behind = [&](int stride, std::uint64_t seed) {
        return render(*with, screen_space(3, 2, stride), 30, 0, seed).layers.at("hidden_light_2");
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
    CHECK_THAT(
        refusal(
            R"(<compensation type="screen_space"><string name="receivers" value="media"/></compensation>)"),
        ContainsSubstring("known: surfaces") && ContainsSubstring("'media'"));
    CHECK_THAT(
        refusal(R"(<compensation type="screen_space"><integer name="steps" value="0"/></compensation>)"),
        ContainsSubstring("steps"));
    CHECK_THAT(refusal(screen_space(2, 0)), ContainsSubstring("layers"));
    CHECK_THAT(refusal(R"(<compensation type="screen_space"/>)", -1.0), ContainsSubstring("no bound"));
    CHECK(refusal(R"(<compensation type="screen_space"/>)") == "accepted");
}

TEST_CASE("an interrupted render is compensated, as one of so many passes",
          "[compensation][ssbc][stopping]") {
    const auto scene = scene_from(corner, 16);
    const auto integrator = integrator_from(vpl(screen_space(2, 1)));
    std::atomic<bool> flag{false};
    core::RenderRequest request;
    request.stop.passes = 3;
    const core::RenderResult whole = core::render(*scene, *integrator, request);
    request.stop.passes = 9, request.interrupted = &flag;
    request.progress = [&](const core::RenderProgress& p) { flag = p.passes == 3; };
    const core::RenderResult interrupted = core::render(*scene, *integrator, request);
    REQUIRE(interrupted.interrupted);
    CHECK((interrupted.film.beauty() == whole.film.beauty()));
    CHECK_FALSE(interrupted.finished_for);
}
