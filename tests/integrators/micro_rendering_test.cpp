// `mote_micro_rendering` against the path tracer. It is biased by the size of points and texels, so means are
// compared within a stated bound, which shrinks with more of both.
#include <cmath>

#include "core/objects/error.h"
#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::shared_ptr<const Integrator> micro(const std::string& settings, int max_depth, int points = 3000,
                                        int texels = 12) {
    return integrator_from(fmt::format(
        R"(<integrator type="mote_micro_rendering"><integer name="points" value="{}"/>
        <integer name="micro_buffer" value="{}"/><float name="cut" value="0.1"/>
        <integer name="max_depth" value="{}"/>{}</integrator>)",
        points, texels, max_depth, settings));
}
std::shared_ptr<const Integrator> path(int max_depth) {
    return integrator_from(fmt::format(
        R"(<integrator type="path"><integer name="max_depth" value="{}"/></integrator>)", max_depth));
}
std::string word(const std::string& name, const std::string& value) {
    return fmt::format(R"(<string name="{}" value="{}"/>)", name, value);
}
std::string number(const std::string& name, int value) {
    return fmt::format(R"(<integer name="{}" value="{}"/>)", name, value);
}

const std::string unbounded = R"(<float name="bound" value="0"/>)";

/// Mean over channels of a layer, and its standard error.
Estimate mean_of(const RenderStatistics& r, const std::string& layer) {
    Estimate sum;
    for (const Estimate& channel : r.whole[r.layer(layer)])
        sum.mean += channel.mean / 3.0, sum.variance_of_mean += channel.variance_of_mean / 3.0;
    return sum;
}

struct Difference {
    double relative, error;
    /// Is it no more than `bias`, but for 4.5 standard errors?
    bool within(double bias) const { return std::fabs(relative) < bias + 4.5 * error; }
};
Difference difference(const RenderStatistics& found, const RenderStatistics& expected,
                      const std::string& layer, double factor = 1.0) {
    const Estimate a = mean_of(found, layer), b = mean_of(expected, layer);
    return {factor * a.mean / b.mean - 1.0, std::sqrt(a.variance_of_mean + b.variance_of_mean) / b.mean};
}

double value_after_a_pass(const Scene& scene, const Integrator& integrator, const std::string& name) {
    Film film(scene.film().width, scene.film().height, integrator.layers(scene));
    PassRunner runner(scene, integrator, 3, film);
    const std::atomic<bool> cancelled = false;
    REQUIRE(runner.run_pass(cancelled));
    Statistics statistics;
    runner.estimator().add_statistics(statistics);
    return statistics.values.at(name);
}

}  // namespace

// Discs of radius r stand out beyond the block's edges, of length 0.6, by up to r on either side, and hide or
// shine by 4 r / 0.6 of its area. The block covers no more than an eighth of what any point sees.
TEST_CASE("micro-rendering has the mean of path, within the size of its points",
          "[micro_rendering][equality]") {
    struct Case {
        std::string wall, settings;
        int max_depth, points = 2000;
    };
    const auto c =
        GENERATE(Case{grey, word("light", "direct"), 3, 500}, Case{grey, word("light", "direct"), 3, 4500},
                 Case{grey, word("light", "radiosity"), 5},
                 Case{grey, word("light", "vpls") + number("paths", 40) + unbounded, 4},
                 Case{grey, word("light", "photons") + number("paths", 4000), 4},
                 Case{grey, word("light", "direct") + number("upsampling", 2), 3});
    CAPTURE(c.settings, c.max_depth);
    const auto scene = scene_from(box(c.wall, ""), 12);
    const auto expected = render_statistics(*scene, *path(c.max_depth), {.block = 12, .passes = 300});
    const auto found = render_statistics(*scene, *micro(c.settings, c.max_depth, c.points),
                                         {.block = 12, .passes = 8, .seed = 2});
    // All areas, the lamp's among them; a disc covers what its point represents about twice.
    const double area = 5 * 4.0 + 6 * 0.36 + 0.25, disc = std::sqrt(2.0 * area / (c.points * 3.14159265));
    const double bias = 4.0 * disc / 0.6 / 8.0;
    const Difference direct = difference(found, expected, "direct"),
                     indirect = difference(found, expected, "indirect");
    CAPTURE(direct.relative, direct.error, indirect.relative, indirect.error, bias);
    CHECK(direct.within(0.0));
    CHECK(indirect.within(bias));
    for (const double sign : {-1.0, 1.0}) {  // planted
        const double factor = 1.0 + sign * (2.0 * bias + 9.0 * indirect.error);
        CHECK_FALSE(difference(found, expected, "indirect", factor).within(bias));
    }
}

// A diffuse floor, lit by a point, in a glossy wall: nothing else sends light to what is seen. The floor is 2
// by 2, and its discs make it larger by their radius on either side of its border.
TEST_CASE("glossy receivers have the mean of path", "[micro_rendering][equality]") {
    const std::string light =
        R"(<emitter type="point"><point name="position" x="0" y="0" z="0"/><rgb name="intensity" value="3"/></emitter>)";
    const std::string floor =
        R"(<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><translate y="-1"/></transform>
        <bsdf type="diffuse"><rgb name="reflectance" value="0.8, 0.6, 0.4"/></bsdf></shape>)";
    const std::string wall =
        R"(<shape type="rectangle"><transform name="to_world"><translate z="-1"/></transform>)";
    const std::string camera =
        R"(<sensor type="perspective"><float name="fov" value="24"/><transform name="to_world">
        <lookat origin="0, 0.4, 3" target="0, -0.1, -1" up="0, 1, 0"/></transform></sensor></scene>)";
    const auto scene =
        scene_from("<scene version=\"3.0.0\">" + light + floor + wall + glossy + "</shape>" + camera, 8);
    const auto expected = render_statistics(*scene, *path(3), {.block = 8, .passes = 600});
    const int points = 3000;
    const double disc = std::sqrt(2.0 * 8.0 / (points * 3.14159265)), bias = 2.0 * disc;
    const auto found = render_statistics(*scene, *micro(word("light", "direct"), 3, points),
                                         {.block = 8, .passes = 8, .seed = 2});
    const Difference indirect = difference(found, expected, "indirect");
    CAPTURE(indirect.relative, indirect.error, bias);
    CHECK(indirect.within(bias));
    CHECK_FALSE(difference(found, expected, "indirect", 0.7).within(bias));
}

TEST_CASE("upsampling gathers at fewer pixels, and at those that have no neighbours alike",
          "[micro_rendering]") {
    const auto scene = scene_from(box(grey, ""), 24), shiny = scene_from(box(glossy, ""), 24);
    const std::string direct = word("light", "direct"), quarter = direct + number("upsampling", 2);
    const std::string shared = quarter + R"(<boolean name="glossy_upsampling" value="true"/>)";
    const auto receivers = [](const Scene& s, const std::string& settings) {
        return value_after_a_pass(s, *micro(settings, 3, 300, 4), "receivers");
    };
    const double all = receivers(*scene, direct);
    CHECK(receivers(*scene, quarter) < 0.7 * all);
    CHECK(receivers(*scene, quarter) >= 0.25 * all);
    CHECK(receivers(*shiny, quarter) > 0.9 * receivers(*shiny, direct));
    CHECK(receivers(*shiny, shared) < 0.7 * receivers(*shiny, direct));
}

TEST_CASE("mirrors show what points light", "[micro_rendering]") {
    std::string xml = box(grey, "");
    const std::string mirror = R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)";
    xml.insert(xml.find("<sensor"), R"(<shape type="rectangle"><transform name="to_world"><scale value="0.5"/>
        <rotate y="1" angle="35"/><translate z="-0.6"/></transform>)" +
                                        mirror + "</shape>");
    const auto scene = scene_from(xml, 8);
    const auto picture = render_statistics(*scene, *micro(word("light", "direct"), 4, 500, 6), {8, 4, 1});
    const auto shorter = render_statistics(*scene, *micro(word("light", "direct"), 3, 500, 6), {8, 4, 1});
    const double seen = mean_of(picture, "indirect").mean, without = mean_of(shorter, "indirect").mean;
    CHECK(seen > 1.02 * without);
    CHECK(without > 0.0);
}

TEST_CASE("mote_micro_rendering refuses wrong settings, and says what it does", "[micro_rendering][input]") {
    const auto foggy = scene_from(box(grey, R"(<medium type="homogeneous" name="interior"/>)"));
    CHECK_THROWS_AS(micro("", -1)->prepare(*foggy, {}), InputError);
    CHECK(micro("", -1)->plan(*foggy, find_requirements(*foggy)).to_text().find("refused") !=
          std::string::npos);
    for (const std::string& wrong :
         {number("micro_buffer", 0), number("micro_buffer", 257), number("points", 0), word("light", "lamp"),
          number("upsampling", 0), std::string(R"(<float name="cut" value="0"/>)")})
        CHECK_THROWS_AS(
            integrator_from("<integrator type=\"mote_micro_rendering\">" + wrong + "</integrator>"),
            InputError);
    const auto scene = scene_from(box(mixed, ""));
    const auto plan = [&](const std::string& settings) {
        return micro(settings, -1)->plan(*scene, find_requirements(*scene)).to_text();
    };
    // Points beyond the memory: the plan says so, and nothing is sampled.
    const auto many = micro("", -1, 1 << 24);
    CHECK_THROWS_AS(many->prepare(*scene, {}), InputError);
    const std::string text = many->plan(*scene, find_requirements(*scene)).to_text();
    CHECK(text.find("fit into the") != std::string::npos);
    CHECK(plan("").find("refused") == std::string::npos);
    CHECK(plan("").find("12 x 12 texels") != std::string::npos);
    CHECK(plan("").find("reflect to others like diffuse ones") != std::string::npos);
    CHECK(plan(word("light", "vpls")).find("is darkened") != std::string::npos);
    CHECK(plan(word("light", "vpls") + unbounded).find("is darkened") == std::string::npos);
    CHECK(plan(number("upsampling", 4)).find("4 x 4") != std::string::npos);
    CHECK(plan(R"(<boolean name="ray_casting" value="false"/>)").find("leaves holes") != std::string::npos);
}
