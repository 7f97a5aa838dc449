// Eye rays of mote_vpl through media: by one collision or the surface, and by scattering points with the
// surface behind them. Both have the mean of volpath, layer by layer, along segments that meet everything at
// once.
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

/// The box seen in a mirror; before it a coloured fog that scatters forwards, a filter that only absorbs, and
/// a thin pane; inside it `medium`.
std::string many_things(const std::string& medium) {
    std::string xml = box(grey, medium);
    xml.erase(xml.find("<sensor"));
    const auto slab = [](double x0, double x1, const std::string& inside) {
        return fmt::format(R"(<shape type="cube"><transform name="to_world"><scale x="{}" y="2" z="0.9"/>
            <translate x="{}" z="4"/></transform><bsdf type="null"/>{}</shape>)",
                           (x1 - x0) / 2, (x0 + x1) / 2, inside);
    };
    xml +=
        slab(0.6, 1.4, R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.2, 0.5, 1"/>
        <rgb name="albedo" value="0.9"/><phase type="hg"><float name="g" value="0.5"/></phase></medium>)");
    xml +=
        slab(1.6, 2.0, R"(<medium type="homogeneous" name="interior"><rgb name="sigma_t" value="1, 0.3, 0.1"/>
        <rgb name="albedo" value="0"/></medium>)");
    xml +=
        R"(<shape type="rectangle"><transform name="to_world"><scale value="1.5"/><translate z="2"/></transform>
        <bsdf type="thindielectric"/></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="1.2"/><rotate y="1" angle="135"/>
        <translate z="4"/></transform><bsdf type="twosided"><bsdf type="conductor"><string name="material"
        value="none"/></bsdf></bsdf></shape>
        <sensor type="perspective"><float name="fov" value="30"/><transform name="to_world">
        <lookat origin="2.4, 0, 4" target="0, 0, 4" up="0, 1, 0"/></transform></sensor></scene>)";
    return xml;
}

std::string vpl(int points, const std::string& more = "") {
    return fmt::format(
        R"(<integrator type="mote_vpl"><integer name="paths" value="16"/><float name="bound" value="1"/>
        <integer name="scattering_points" value="{}"/>{}</integrator>)",
        points, more);
}

const std::vector<std::string> layers = {
    "emission", "direct", "indirect_bounded", "single_scattering", "multiple_scattering_bounded", "beauty"};

void check_same(const RenderStatistics& a, const RenderStatistics& b) {
    for (const std::string& layer : layers) {
        if (layer == "emission")
            check_same_mean(a, layer, b, layer);
        else
            check_same_mean(a, layer, b, layer, {1.12, 0.88});
    }
}

double variance(const RenderStatistics& r, const std::string& layer) {
    double sum = 0.0;
    for (const Estimate& e : r.blocks[r.layer(layer)]) sum += e.variance_of_mean;
    return sum * r.passes;
}

}  // namespace

TEST_CASE("scattering points have the mean of volpath behind a mirror, a pane and three media",
          "[vpl][scattering_points][equality]") {
    const TemporaryFolder folder;
    const auto scene = scene_from(many_things(smoke_medium(folder.file("smoke.vol"))), 8);
    const auto reference = render_statistics(
        *scene,
        *integrator_from(R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)"),
        {4, 4000, 2});
    const auto tossed = render_statistics(*scene, *integrator_from(vpl(0)), {4, 1500, 3});
    const auto points = render_statistics(*scene, *integrator_from(vpl(3)), {4, 600, 4});
    check_same(tossed, reference);
    check_same(points, reference);
    CHECK(variance(points, "single_scattering") < 0.5 * variance(tossed, "single_scattering"));
    CHECK(variance(points, "multiple_scattering_bounded") <
          0.8 * variance(tossed, "multiple_scattering_bounded"));
}

TEST_CASE("one point or many, with few edges or hidden lights: the same mean",
          "[vpl][scattering_points][equality]") {
    const auto scene = scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 8);
    for (const std::string more :
         {R"(<integer name="max_depth" value="3"/>)", R"(<integer name="eye_samples" value="2"/>
             <boolean name="hide_emitters" value="true"/>)"}) {
        INFO(more);
        const auto tossed = render_statistics(*scene, *integrator_from(vpl(0, more)), {4, 900, 5});
        for (const int points : {1, 5})
            check_same(render_statistics(*scene, *integrator_from(vpl(points, more)), {4, 400, 6}), tossed);
    }
    const auto two = render_statistics(
        *scene, *integrator_from(vpl(4, R"(<integer name="max_depth" value="1"/>)")), {4, 2, 7});
    for (const auto& channel : two.whole[two.layer("single_scattering")]) CHECK(channel.mean == 0.0);
}
