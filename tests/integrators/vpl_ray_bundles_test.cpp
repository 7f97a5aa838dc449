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
        <integer name="directions" value="3"/><integer name="joined" value="3"/>)" +
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
    const auto c = GENERATE(
        Case{grey, "", 3}, Case{grey, "", 4}, Case{mixed, "", 5},
        Case{grey, R"(<integer name="interleaving" value="2"/><integer name="direct_paths" value="3"/>)", 5},
        Case{mixed, R"(<float name="continuation" value="0.7"/><integer name="direct_paths" value="1"/>)", 5},
        Case{grey, R"(<string name="techniques" value="bundles"/>)", 3},
        Case{grey, R"(<string name="techniques" value="bundles"/><integer name="bounces" value="3"/>)", 5});
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

// Tokuyoshi & Ogaki 2012, Sec. 7: "randomly select a single ray-bundle". With M lines one path in M of two
// bounces goes straight back to where it came from.
TEST_CASE("paths that may take a direction again are biased", "[bundles]") {
    const auto scene = scene_from(box(grey, ""), 12);
    const auto mean = [&](const std::string& settings) {
        const auto found = render_statistics(
            *scene,
            *bundles(R"(<string name="techniques" value="bundles"/><integer name="bounces" value="2"/>)" +
                     settings + depth(4)),
            {.block = 12, .passes = 600});
        return found.whole[found.layer("indirect")][1];
    };
    const Estimate right = mean(""), biased = mean(R"(<boolean name="repeats" value="true"/>)");
    CAPTURE(right.mean, biased.mean, right.variance_of_mean);
    CHECK(std::fabs(right.mean - biased.mean) >
          4.5 * std::sqrt(right.variance_of_mean + biased.variance_of_mean));
}

// A grid moves contacts by half a spacing at most, and discs leave holes: what that costs in the mean is
// bounded by what was measured, 0.1 and 2 % of the room's indirect light, with room for the noise of these
// passes.
TEST_CASE("bundles that are looked up have the light of rays, within what grids and discs cost",
          "[bundles][statistics]") {
    const auto scene = scene_from(box(grey, ""), 12);
    const auto mean = [&](const std::string& settings) {
        const auto found =
            render_statistics(*scene, *bundles(settings + depth(4)), {.block = 12, .passes = 150});
        return found.whole[found.layer("indirect")][1];
    };
    const Estimate rays = mean("");
    const auto links = [](const std::string& kind, const std::string& more) {
        return R"(<string name="links" value=")" + kind + "\"/>" + more;
    };
    const Estimate grid = mean(links("grid", ""));
    const Estimate discs = mean(links("imperfect", R"(<integer name="link_points" value="16384"/>)"));
    // Far too coarse: half of the room between two rays.
    const Estimate coarse = mean(links("grid", R"(<float name="link_spacing" value="0.7"/>)"));
    const auto within = [&](const Estimate& found, double bias) {
        const double sigma = std::sqrt(rays.variance_of_mean + found.variance_of_mean);
        return std::fabs(found.mean - rays.mean) < bias * rays.mean + 4.5 * sigma;
    };
    CAPTURE(rays.mean, grid.mean, discs.mean, coarse.mean, std::sqrt(rays.variance_of_mean));
    CHECK(std::sqrt(rays.variance_of_mean) < 0.02 * rays.mean);
    CHECK(within(grid, 0.005));
    CHECK(within(discs, 0.04));
    CHECK(grid.mean != rays.mean);
    CHECK(discs.mean != grid.mean);
    CHECK(coarse.mean != grid.mean);
}

TEST_CASE("mote_vpl_ray_bundles refuses media and wrong settings, and says what it does",
          "[bundles][input]") {
    const auto foggy = scene_from(box(grey, R"(<medium type="homogeneous" name="interior"/>)"));
    CHECK_THROWS_AS(bundles("")->prepare(*foggy, {}), InputError);
    for (const char* wrong :
         {R"(<integer name="directions" value="-1"/>)", R"(<float name="bound" value="0"/>)",
          R"(<float name="continuation" value="1"/>)", R"(<string name="links" value="grids"/>)",
          R"(<float name="splat_size" value="0"/>)", R"(<float name="link_spacing" value="-1"/>)",
          R"(<string name="techniques" value="both"/>)", R"(<integer name="joined" value="-3"/>)",
          R"(<integer name="bounces" value="2"/>)",
          R"(<string name="techniques" value="bundles"/><integer name="bounces" value="4"/>)"})
        CHECK_THROWS_AS(bundles(wrong), InputError);
    const auto scene = scene_from(box(grey, ""));
    const auto plan = [&](const std::string& settings) {
        return bundles(settings)->plan(*scene, find_requirements(*scene)).to_text();
    };
    CHECK(plan("").find("balance heuristic") != std::string::npos);
    CHECK(plan(R"(<boolean name="roughness_clamping" value="true"/>)").find("blurs them") !=
          std::string::npos);
    CHECK(plan(R"(<string name="links" value="imperfect"/>)").find("holes between discs") !=
          std::string::npos);
    CHECK(plan("").find("go on by a chance") != std::string::npos);
    CHECK(plan(R"(<float name="bound" value="2"/>)").find("go on by a chance") == std::string::npos);
    CHECK(plan(R"(<float name="bound" value="2"/>)").find("darkened") != std::string::npos);
    CHECK(bundles("")->plan(*foggy, find_requirements(*foggy)).to_text().find("refused") !=
          std::string::npos);
}
