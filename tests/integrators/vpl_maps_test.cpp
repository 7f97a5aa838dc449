// Reflective and imperfect shadow maps in `mote_vpl`: the former keep the mean, the latter come close to
// shadow rays, by how much is stated.
#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::string vpl(const std::string& settings, int paths = 64) {
    return fmt::format(
        R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/><float name="bound" value="1"/>{}</integrator>)",
        paths, settings);
}
const std::string reflective = R"(<integer name="reflective_shadow_maps" value="6"/>)";
const std::string imperfect = R"(<visibility type="imperfect_shadow_map"/>)";

/// The box, with a point light and a spot besides its lamp.
std::string lit_box(const std::string& medium) {
    std::string xml = box(grey, medium);
    xml.insert(xml.find("<sensor"), R"(<emitter type="point"><point name="position" x="-0.5" y="0.3" z="0.3"/>
        <rgb name="intensity" value="2, 1, 1"/></emitter>
        <emitter type="spot"><rgb name="intensity" value="3, 4, 5"/><float name="cutoff_angle" value="40"/>
        <transform name="to_world"><lookat origin="0.5, 0.5, 0.5" target="-0.2, -0.9, -0.3" up="0, 1, 0"/></transform></emitter>)");
    return xml;
}

/// The mean picture of light of VPLs on surfaces.
std::vector<core::Rgb> picture(const core::Scene& scene, const std::string& integrator, int passes) {
    const auto method = integrator_from(integrator);
    core::Film film(scene.film().width, scene.film().height, method->layers(scene));
    core::PassRunner runner(scene, *method, 3, film);
    const std::atomic<bool> cancelled = false;
    for (int i = 0; i < passes; ++i) REQUIRE(runner.run_pass(cancelled));
    for (std::size_t i = 0; i < film.layers().size(); ++i)
        if (film.layers()[i].name == "indirect_bounded") return film.mean(i);
    FAIL("no light of VPLs");
    return {};
}

struct Difference {
    double mean = 0.0, absolute = 0.0;  ///< of the mean of the second picture
};
Difference difference(const std::vector<core::Rgb>& a, const std::vector<core::Rgb>& b) {
    Difference d;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += double(core::average(b[i]));
        d.mean += double(core::average(a[i] - b[i]));
        d.absolute += std::fabs(double(core::average(a[i] - b[i])));
    }
    return {d.mean / sum, d.absolute / sum};
}

}  // namespace

TEST_CASE("VPLs by reflective shadow maps have the mean of volpath",
          "[vpl][reflective_shadow_maps][equality]") {
    for (const std::string& medium : {std::string(), fog("0.6", "")}) {
        const auto scene = scene_from(lit_box(medium), 8);
        const auto reference = render_statistics(
            *scene,
            *integrator_from(
                R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)"),
            {4, 600, 2});
        const auto render = render_statistics(*scene, *integrator_from(vpl(reflective, 16)), {4, 150, 5});
        for (const std::string layer : {"direct", "indirect_bounded"}) {
            check_same_mean(render, layer, reference, layer, {1.15});
        }
    }
}

TEST_CASE("A picture by imperfect shadow maps is that of shadow rays but for a stated error",
          "[vpl][imperfect_shadow_maps]") {
    const auto scene = scene_from(box(grey, ""), 24);
    const auto traced = picture(*scene, vpl(""), 4);
    const auto mapped = picture(*scene, vpl(imperfect), 4);
    // Visibility alone differs: the VPLs are the same.
    const Difference usual = difference(mapped, traced);
    INFO("mean " << usual.mean << ", absolute " << usual.absolute);
    CHECK(std::fabs(usual.mean) < 0.03);
    CHECK(usual.absolute < 0.06);
    CHECK(usual.absolute > 0.001);  // they are imperfect
    const Difference none = difference(
        picture(*scene, vpl(R"(<visibility type="imperfect_shadow_map"><float name="splat" value="0"/>
            <integer name="points" value="1"/></visibility>)"),
                8),
        traced);
    CHECK(none.mean > 0.05);  // without points there are no shadows
}

TEST_CASE("Imperfect shadow maps take media into account and refuse settings out of range",
          "[vpl][imperfect_shadow_maps]") {
    const auto scene = scene_from(box(grey, fog("0.6", "")), 12);
    const Difference d = difference(picture(*scene, vpl(imperfect), 4), picture(*scene, vpl(""), 4));
    CHECK(std::fabs(d.mean) < 0.04);
    for (const std::string bad :
         {R"(<integer name="size" value="1"/>)", R"(<integer name="points" value="0"/>)",
          R"(<integer name="points" value="100"/><integer name="all_points" value="50"/>)",
          R"(<float name="bias" value="-1"/>)"})
        CHECK_THROWS_AS(
            integrator_from(vpl(R"(<visibility type="imperfect_shadow_map">)" + bad + "</visibility>")),
            core::InputError);
}
