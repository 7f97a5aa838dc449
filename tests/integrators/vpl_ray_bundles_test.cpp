// `mote_vpl_ray_bundles` against the path tracer: with all its techniques, with shares, behind masks and
// glass.
#include "core/objects/error.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::tests;

namespace {

std::shared_ptr<const Integrator> bundles(const std::string& settings) {
    return integrator_from(R"(<integrator type="mote_vpl_ray_bundles"><integer name="paths" value="12"/>
        <integer name="directions" value="3"/>)" +
                           settings + "</integrator>");
}
std::string depth(int max_depth) {
    return fmt::format(R"(<integer name="max_depth" value="{}"/>)", max_depth);
}
std::shared_ptr<const Integrator> path(int max_depth) {
    return integrator_from(R"(<integrator type="path">)" + depth(max_depth) + "</integrator>");
}

}  // namespace

TEST_CASE("virtual point lights and ray-bundles render the picture of path", "[bundles][equality]") {
    struct Case {
        std::string wall, settings;
        int max_depth;
    };
    const auto c = GENERATE(Case{grey, "", 3}, Case{grey, "", 4}, Case{mixed, "", 5},
                            Case{grey, R"(<integer name="interleaving" value="2"/>)", 5},
                            Case{mixed, R"(<string name="glossy" value="lines"/>)", 4},
                            Case{grey, R"(<string name="techniques" value="bundles"/>)", 3},
                            Case{grey, R"(<string name="techniques" value="reused_bundles"/>)", 5});
    const auto scene = scene_from(box(c.wall, ""), 12);
    CAPTURE(c.settings, c.max_depth);
    const auto expected = render_statistics(*scene, *path(c.max_depth), {.block = 4, .passes = 800});
    const auto found = render_statistics(*scene, *bundles(c.settings + depth(c.max_depth)),
                                         {.block = 4, .passes = 300, .seed = 2});
    for (const std::string layer : {"direct", "indirect", "beauty"}) {
        check_same_mean(expected, layer, found, layer);
    }
    CHECK_FALSE(same_mean(expected, "indirect", found.scaled(1.1), "indirect", OnFailure::nothing).passed);
}

TEST_CASE("the sky's direct light by bundles is that of connections", "[bundles][equality]") {
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"),
               R"(<emitter type="constant"><rgb name="radiance" value="1, 1.2, 1.5"/></emitter>)");
    const auto scene = scene_from(xml, 12);
    const auto expected = render_statistics(*scene, *path(3), {.block = 4, .passes = 800});
    const auto found = render_statistics(*scene, *bundles(R"(<boolean name="sky" value="true"/>)" + depth(3)),
                                         {.block = 4, .passes = 300, .seed = 2});
    for (const std::string layer : {"emission", "direct", "indirect"}) {
        check_same_mean(expected, layer, found, layer);
    }
}

// Eqs. 7 and 8: the bound takes light of two bounces, and of nothing else.
TEST_CASE("a bound of paths of two bounces only darkens them", "[bundles]") {
    const auto scene = scene_from(box(grey, ""), 12);
    const auto mean = [&](const std::string& settings) {
        const auto found = render_statistics(*scene, *bundles(settings), {.block = 12, .passes = 300});
        const std::string layer =
            settings.find("bound") == std::string::npos ? "indirect" : "indirect_bounded";
        return found.whole[found.layer(layer)][1];
    };
    const std::string bound = R"(<float name="bound" value="0.1"/>)";
    const Estimate whole = mean(depth(4)), bounded = mean(bound + depth(4));
    const Estimate one = mean(depth(3)), one_bounded = mean(bound + depth(3));
    const auto sigma = [](const Estimate& a, const Estimate& b) {
        return (a.mean - b.mean) / std::sqrt(a.variance_of_mean + b.variance_of_mean);
    };
    CHECK(sigma(whole, bounded) > 5.0);
    CHECK(std::fabs(sigma(one, one_bounded)) < 4.5);
    CHECK(bounded.mean > one_bounded.mean);
}

// Discs leave holes: the cost in the mean is bounded by what was measured, 2 % of the room's indirect light,
// with room for the noise of these passes.
TEST_CASE("imperfect bundles have the light of rays, within what holes cost", "[bundles][statistics]") {
    const auto scene = scene_from(box(grey, ""), 12);
    const auto mean = [&](const std::string& settings) {
        const auto found =
            render_statistics(*scene, *bundles(settings + depth(4)), {.block = 12, .passes = 150});
        return found.whole[found.layer("indirect")][1];
    };
    const Estimate rays = mean(""), discs = mean(R"(<string name="links" value="imperfect"/>)");
    const double sigma = std::sqrt(rays.variance_of_mean + discs.variance_of_mean);
    CAPTURE(rays.mean, discs.mean, sigma);
    CHECK(std::sqrt(rays.variance_of_mean) < 0.02 * rays.mean);
    CHECK(std::fabs(discs.mean - rays.mean) < 0.04 * rays.mean + 4.5 * sigma);
    CHECK(discs.mean != rays.mean);
}

TEST_CASE("mote_vpl_ray_bundles refuses media and wrong settings, and says what it does",
          "[bundles][input]") {
    const auto foggy = scene_from(box(grey, R"(<medium type="homogeneous" name="interior"/>)"));
    CHECK_THROWS_AS(bundles("")->prepare(*foggy, {}), InputError);
    for (const char* wrong :
         {R"(<integer name="directions" value="-1"/>)", R"(<float name="bound" value="0"/>)",
          R"(<string name="links" value="grid"/>)", R"(<string name="techniques" value="both"/>)",
          R"(<string name="glossy" value="none"/>)", R"(<integer name="interleaving" value="9"/>)"})
        CHECK_THROWS_AS(bundles(wrong), InputError);
    const auto scene = scene_from(box(grey, ""));
    const auto plan = [&](const std::string& settings) {
        return bundles(settings)->plan(*scene, find_requirements(*scene)).to_text();
    };
    CHECK(plan("").find("balance heuristic") != std::string::npos);
    CHECK(plan(R"(<string name="glossy" value="clamping"/>)").find("blurs them") != std::string::npos);
    CHECK(plan(R"(<string name="links" value="imperfect"/>)").find("holes between discs") !=
          std::string::npos);
    CHECK(plan(R"(<string name="techniques" value="reused_bundles"/>)").find("no more than 3") !=
          std::string::npos);
    CHECK(plan("").find("continue by a chance") != std::string::npos);
    CHECK(plan(R"(<float name="bound" value="2"/>)").find("continue by a chance") == std::string::npos);
    CHECK(plan(R"(<float name="bound" value="2"/>)").find("darkened") != std::string::npos);
    CHECK(bundles("")->plan(*foggy, find_requirements(*foggy)).to_text().find("refused") !=
          std::string::npos);
}
