// Virtual point lights selected by a hierarchy, in `mote_vpl`: the mean of all lights where nothing is left
// out and where lights are sampled, the same picture by a lightcut without an error, and plans that say what
// is best.
#include "core/objects/error.h"
#include "core/render/pass_runner.h"
#include "core/render/render_driver.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(const std::string& selection, const std::string& settings = "", int paths = 16) {
    return fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>
        <float name="bound" value="1"/>{}{}</integrator>)",
                       paths, selection, settings);
}
std::string sampled(const std::string& type, int samples) {
    return fmt::format(R"(<selection type="{}"><integer name="samples" value="{}"/></selection>)", type,
                       samples);
}
std::string cut(const std::string& type, double threshold, int max_cut = 1 << 20) {
    return fmt::format(R"(<selection type="{}"><float name="threshold" value="{}"/>
        <integer name="max_cut" value="{}"/></selection>)",
                       type, threshold, max_cut);
}

std::string resampled(int candidates = 24, int samples = 3) {
    return fmt::format(R"(<selection type="resampling"><integer name="candidates" value="{}"/>
        <integer name="samples" value="{}"/></selection>)",
                       candidates, samples);
}

std::string matrix(int rows, int columns, int slices) {
    return fmt::format(R"(<selection type="matrix"><integer name="rows" value="{}"/>
        <integer name="columns" value="{}"/><integer name="slices" value="{}"/>
        <string name="row_visibility" value="rays"/></selection>)",
                       rows, columns, slices);
}

std::vector<core::Rgb> picture(const core::Scene& scene, const std::string& integrator,
                               core::Statistics* statistics = nullptr) {
    const auto method = integrator_from(integrator);
    core::Film film(scene.film().width, scene.film().height, method->layers(scene));
    core::PassRunner runner(scene, *method, 3, film);
    const std::atomic<bool> cancelled = false;
    REQUIRE(runner.run_pass(cancelled));
    if (statistics) runner.estimator().add_statistics(*statistics);
    return film.beauty();
}

/// `same` is `all` to rounding; `other`, which is not, is seen to differ.
void check_same_and_other(const std::vector<core::Rgb>& all, const std::vector<core::Rgb>& same,
                          const std::vector<core::Rgb>& other) {
    std::size_t wrong = 0, differ = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            wrong += std::fabs(same[i][k] - all[i][k]) > 3e-5f * all[i][k] + 1e-7f;
            differ += std::fabs(other[i][k] - all[i][k]) > 1e-3f * all[i][k];
        }
    CHECK(wrong == 0);
    CHECK(differ > all.size() / 2);
}

}  // namespace

TEST_CASE("selected VPLs have the mean of volpath", "[vpl][selection][equality]") {
    const std::string two = R"(<integer name="eye_samples" value="2"/>)";
    const std::string apart = R"(<integer name="interleaving" value="2"/>)";
    struct Case {
        std::string medium;
        std::vector<std::string> settings;
        double planted;
    };
    const std::string haze =
        fog("0.8, 1.0, 1.3", R"(<phase type="hg"><float name="g" value="0.5"/></phase>)");
    for (const Case& c :
         {Case{"",
               {sampled("uniform", 8), sampled("light_tree", 8), sampled("stochastic_lightcuts", 8),
                matrix(32, 9, 2), resampled()},
               1.15},
          Case{haze,
               {sampled("uniform", 6) + two, sampled("light_tree", 6) + apart,
                sampled("stochastic_lightcuts", 6) + two, cut("multidimensional_lightcuts", 0.0) + two,
                matrix(32, 9, 2) + apart, resampled() + apart, resampled() + two},
               1.25}}) {
        const auto scene = scene_from(box(c.medium.empty() ? mixed : grey, c.medium), 8);
        const auto reference = render_statistics(
            *scene,
            *integrator_from(
                R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)"),
            {4, 1500, 2});
        for (const std::string& settings : c.settings) {
            const auto render =
                render_statistics(*scene, *integrator_from(vpl(settings, "", 6)), {4, 250, 5});
            for (const std::string layer : {"indirect_bounded", "multiple_scattering_bounded"}) {
                if (c.medium.empty() && layer == "multiple_scattering_bounded") continue;
                INFO(settings);
                check_same_mean(render, layer, reference, layer, {c.planted});
            }
        }
    }
}

TEST_CASE("A lightcut with a threshold of 0 is the picture of all VPLs", "[vpl][selection]") {
    const std::string collisions = R"(<integer name="scattering_points" value="0"/>)";
    for (const bool media : {false, true}) {
        const auto scene = scene_from(media ? box(grey, fog("0.8, 0.8, 0.8", "")) : box(mixed, ""), 18);
        const auto all = picture(*scene, vpl("", collisions, 60));
        for (const std::string type : {"lightcuts", "multidimensional_lightcuts"}) {
            const auto same = picture(*scene, vpl(cut(type, 0.0), collisions, 60));
            const auto other = picture(*scene, vpl(cut(type, 0.0, 30), collisions, 60));
            check_same_and_other(all, same, other);
        }
    }
}

TEST_CASE("Few rays for many VPLs", "[vpl][selection]") {
    const auto scene = scene_from(box(grey, ""), 16);
    const auto rays = [&](const std::string& selection) {
        core::Statistics statistics;
        picture(*scene, vpl(selection, "", 4000), &statistics);
        return double(statistics.rays.at("occlusion"));
    };
    const double all = rays("");
    CHECK(rays(sampled("light_tree", 64)) < 0.03 * all);
    CHECK(rays(sampled("stochastic_lightcuts", 64)) < 0.03 * all);
    CHECK(rays(resampled(256, 8)) < 0.002 * all);
    CHECK(rays(cut("lightcuts", 0.02, 1000)) < 0.2 * all);
    // Sixteen rows of all lights, and 64 columns, of a picture of 256 pixels.
    CHECK(rays(matrix(16, 64, 1)) < (0.03 + 16.0 / 256.0) * all);
}

TEST_CASE("Without lights there is nothing to select", "[vpl][selection][extremes]") {
    const auto scene = scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 8);
    for (const int paths : {0, 1})
        for (const std::string& selection :
             {sampled("light_tree", 4), sampled("stochastic_lightcuts", 4), cut("lightcuts", 0.02),
              cut("multidimensional_lightcuts", 0.02), resampled(), matrix(32, 2, 2),
              std::string(R"(<selection type="matrix"/>)")})
            for (const core::Rgb& pixel : picture(*scene, vpl(selection, "", paths)))
                CHECK((std::isfinite(pixel.x) && pixel.x >= 0.0f));
}

TEST_CASE("A matrix with more columns than lights is the picture of all VPLs", "[vpl][selection]") {
    const std::string collisions = R"(<integer name="scattering_points" value="0"/>)";
    for (const bool media : {false, true}) {
        const auto scene = scene_from(media ? box(grey, fog("0.8, 0.8, 0.8", "")) : box(mixed, ""), 12);
        const auto all = picture(*scene, vpl("", collisions, 60));
        const auto same = picture(*scene, vpl(matrix(16, 5000, 2), collisions, 60));
        const auto other = picture(*scene, vpl(matrix(16, 10, 2), collisions, 60));
        check_same_and_other(all, same, other);
    }
}

TEST_CASE("What does not go together with a selection is refused by name", "[vpl][selection]") {
    const std::string selection = sampled("light_tree", 4);
    const std::vector<std::pair<std::string, std::string>> cases{
        {R"(<boolean name="roughness_clamping" value="true"/>)", "roughness_clamping"},
        {R"(<compensation type="exact"/>)", "compensation"},
        {R"(<visibility type="shadow_map"/>)", "shadow maps"}};
    for (const auto& [settings, name] : cases)
        CHECK_THROWS_WITH(integrator_from(vpl(selection, settings)), ContainsSubstring(name));
    CHECK_THROWS_WITH(
        integrator_from(vpl(cut("lightcuts", 0.02), R"(<visibility type="imperfect_shadow_map"/>)")),
        ContainsSubstring("imperfect shadow maps"));
    CHECK_THROWS_WITH(integrator_from(vpl(resampled(), R"(<visibility type="imperfect_shadow_map"/>)")),
                      ContainsSubstring("imperfect shadow maps"));
    CHECK_THROWS_WITH(
        integrator_from(vpl(cut("lightcuts", 0.02), R"(<integer name="interleaving" value="2"/>)")),
        ContainsSubstring("interleaving"));
    CHECK_NOTHROW(integrator_from(vpl(selection, R"(<visibility type="imperfect_shadow_map"/>)")));
}
