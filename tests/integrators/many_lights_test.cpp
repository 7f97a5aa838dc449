// Many lights at once give the sum of the pictures that each gives alone, where there is nothing to choose.
#include <fmt/format.h>

#include "core/render/render_driver.h"
#include "core/scene/requirements.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::tests;

namespace {

/// Lights of every kind that has a place, in the box, outside of its fog: near walls, behind the block, above
/// each other, turned away.
std::vector<std::string> lights() {
    std::vector<std::string> all;
    for (const auto& [x, y, z, angle, radiance] :
         {std::array{-0.6, 0.9, 0.0, 90.0, 20.0}, std::array{0.6, 0.95, -0.95, 60.0, 5.0},
          std::array{0.0, -0.95, 0.5, -90.0, 2.0}, std::array{0.1, 0.93, 0.5, 120.0, 30.0}})
        all.push_back(fmt::format(
            R"(<shape type="rectangle"><transform name="to_world"><scale value="0.08"/><rotate x="1" angle="{}"/>
            <translate x="{}" y="{}" z="{}"/></transform><emitter type="area"><rgb name="radiance" value="{}"/></emitter></shape>)",
            angle, x, y, z, radiance));
    all.push_back(
        R"(<shape type="sphere"><point name="center" x="-0.5" y="0.2" z="1.2"/><float name="radius" value="0.1"/>
        <emitter type="area"><rgb name="radiance" value="3, 5, 9"/></emitter></shape>)");
    all.push_back(R"(<emitter type="point"><point name="position" x="0.6" y="0.4" z="1.2"/>
        <rgb name="intensity" value="1, 1.5, 2"/></emitter>)");
    for (const double x : {-0.7, 0.7})
        all.push_back(
            fmt::format(R"(<emitter type="spot"><transform name="to_world"><lookat origin="{}, 0.7, 1.4"
            target="0, -0.4, 0" up="0, 0, 1"/></transform><rgb name="intensity" value="20, 15, 10"/></emitter>)",
                        x));
    return all;
}

/// Scene text of a light that is switched off: its shape, which reflects nothing.
std::string switched_off(std::string light) {
    const auto begin = light.find("<emitter");
    light.erase(begin, light.rfind("</emitter>") + 10 - begin);
    return light.empty()
               ? light
               : light.insert(begin, R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)");
}

std::string box_with(const std::string& medium, const std::string& lights) {
    std::string xml = box(grey, medium);
    const auto lamp = xml.rfind("<shape", xml.find("<emitter type=\"area\">"));
    xml.erase(lamp, xml.find("</shape>", lamp) + 8 - lamp);
    return xml.insert(xml.find("<sensor"), lights);
}

RenderStatistics render(const std::string& xml, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    return render_statistics(*scene_from(xml, 8), *integrator_from(integrator), {4, passes, seed});
}

void check_sum(const std::string& integrator, const std::string& medium) {
    const std::vector<std::string> all = lights();
    RenderStatistics sum;
    for (std::size_t lit = 0; lit < all.size(); ++lit) {
        std::string xml;
        for (std::size_t i = 0; i < all.size(); ++i) xml += i == lit ? all[i] : switched_off(all[i]);
        const RenderStatistics one = render(box_with(medium, xml), integrator, 400, 100 + lit);
        if (sum.layers.empty()) {
            sum = one;
            continue;
        }
        const auto add = [](Estimate& a, const Estimate& b) {
            a.mean += b.mean, a.variance_of_mean += b.variance_of_mean;
        };
        for (std::size_t layer = 0; layer < sum.layers.size(); ++layer) {
            for (std::size_t i = 0; i < sum.blocks[layer].size(); ++i)
                add(sum.blocks[layer][i], one.blocks[layer][i]);
            for (std::size_t i = 0; i < 3; ++i) add(sum.whole[layer][i], one.whole[layer][i]);
        }
    }
    const RenderStatistics together =
        render(box_with(medium, fmt::format("{}", fmt::join(all, ""))), integrator, 2000, 7);
    for (const char* layer : {"direct", "indirect", "beauty"}) {
        check_same_mean(together, layer, sum, layer, {1.05, 0.95});
    }
}

}  // namespace

TEST_CASE("many lights on surfaces give the sum of what each gives", "[many_lights][equality]") {
    check_sum(R"(<integrator type="path"/>)", "");
}

TEST_CASE("many lights in fog give the sum of what each gives", "[many_lights][equality]") {
    const std::string medium = fog("0.5, 0.6, 0.8", "");
    check_sum(R"(<integrator type="volpath"/>)", medium);
    check_sum(R"(<integrator type="volpath"><boolean name="equiangular" value="true"/></integrator>)",
              medium);
}

TEST_CASE("plans say that lights are chosen by a hierarchy, and why", "[many_lights]") {
    const std::vector<std::string> all = lights();
    const auto plan_of = [](const std::string& light, const char* type) {
        const auto scene = scene_from(box_with("", light), 8);
        return integrator_from(fmt::format(R"(<integrator type="{}"/>)", type))
            ->plan(*scene, mote::core::find_requirements(*scene))
            .to_text();
    };
    for (const char* type : {"path", "volpath", "mote_bdpt", "mote_upbp", "mote_vpl", "mote_vsl",
                             "mote_vpl_ray_bundles", "mote_ray_lights", "mote_photon_map",
                             "mote_micro_rendering", "mote_single_scattering", "mote_epipolar"}) {
        INFO(type);
        const std::string sky = R"(<emitter type="constant"/>)";
        CHECK(plan_of(fmt::format("{}", fmt::join(all, "")), type).find("hierarchy of 8 lights") !=
              std::string::npos);
        CHECK(plan_of(all[0] + all[1] + sky, type).find("1 without a place") != std::string::npos);
        CHECK(plan_of(all[0], type).find("choice of lights") == std::string::npos);
    }
}

TEST_CASE("thousands of lights are refused where every one is marched", "[many_lights]") {
    std::string lights;
    for (int i = 0; i < 5000; ++i)
        lights += fmt::format(
            R"(<emitter type="point"><point name="position" x="{}" y="0.1" z="0.2"/></emitter>)", 1e-4 * i);
    std::string xml = box(grey, fog("1, 1, 1", ""));
    xml.insert(xml.find("<sensor"), lights);
    const auto scene = scene_from(xml, 4);
    mote::core::RenderRequest request;
    request.stop.passes = 1;
    CHECK_THROWS_WITH(
        mote::core::render(*scene, *integrator_from(R"(<integrator type="mote_epipolar"/>)"), request),
        ContainsSubstring("5000 lights"));
    CHECK_NOTHROW(mote::core::render(*scene, *integrator_from(R"(<integrator type="volpath"/>)"), request));
}
