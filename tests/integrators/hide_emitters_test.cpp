// hide_emitters: the camera looks through lamps and does not see the sky, in every integrator, also behind
// panes; light itself is as before.
#include <cmath>
#include <string>
#include <vector>

#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

/// A grey floor seen from 0.1 m above it through a lamp of radiance 5 that shines upwards, and lit from the
/// side by a point light of 8 W/sr at (2, 0, 2), which the lamp does not hide.
std::string floor_behind_lamp(const std::string& more = "", const std::string& camera = "") {
    return R"(<scene version="3.0.0"><shape type="rectangle"><transform name="to_world"><scale value="0.2"/>
        </transform><bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><scale value="0.012"/><translate z="0.05"/></transform>
        <emitter type="area"><rgb name="radiance" value="5"/></emitter></shape><emitter type="point"><point name="position" x="2" y="0" z="2"/>
        <rgb name="intensity" value="8"/></emitter>)" +
           more + R"(<sensor type="orthographic"><transform name="to_world"><scale value="0.01"/>
        <lookat origin="0, 0, 0.1" target="0, 0, 0" up="0, 1, 0"/></transform>)" +
           camera + "</sensor></scene>";
}

/// Radiance of the floor, (rho / pi) I cos / d^2, seen through 0.09 m of a fog of extinction `sigma_t`: mean
/// over the image, 2 cm wide, by Simpson's rule.
double light_of_floor(double sigma_t = 0.0) {
    const double weights[3] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double x = 0.01 * (i - 1), y = 0.01 * (j - 1), d = std::hypot(2.0 - x, y, 2.0);
            sum += weights[i] * weights[j] * 2.0 / (d * d * d) * std::exp(-sigma_t * (0.09 + d));
        }
    return 0.6 / 3.14159265358979 * 8.0 * sum;
}

/// 1 - R of a pane at normal incidence, with all reflections between its faces.
double passes_straight() {
    const double r = (1.5046 - 1.000277) / (1.5046 + 1.000277), R = r * r;
    return 1.0 - 2.0 * R / (1.0 + R);
}

/// A sheet between the camera and the lamp.
std::string sheet(const std::string& bsdf) {
    return R"(<shape type="rectangle"><transform name="to_world"><scale value="0.012"/><translate z="0.07"/>
        </transform>)" +
           bsdf + "</shape>";
}

std::string integrator(const std::string& type, bool hide) {
    std::string text = "<integrator type='" + type + "'><boolean name='hide_emitters' value='" +
                       (hide ? "true" : "false") + "'/>";
    if (type == "mote_vpl" || type == "mote_vsl" || type == "mote_vpl_ray_bundles" ||
        type == "mote_ray_lights")
        text += "<integer name='paths' value='4'/>";
    if (type == "mote_photon_map") text += "<integer name='photon_paths' value='50'/>";
    if (type == "mote_micro_rendering")
        text += "<integer name='points' value='100'/><integer name='micro_buffer' value='4'/>";
    if (type == "mote_ray_bundles")
        text += "<integer name='directions' value='16'/><integer name='texel_budget' value='200'/>";
    return text + "</integrator>";
}

/// Passes of 16 pixels for a standard error below 1 %: paths cross fog and panes at random.
constexpr std::uint32_t passes = 1024;

RenderStatistics render(const Scene& scene, const std::string& type, bool hide,
                        std::uint32_t count = passes) {
    return render_statistics(scene, *integrator_from(integrator(type, hide)), {4, count, 3});
}

double mean_of(const RenderStatistics& picture, const std::string& layer) {
    return picture.whole[picture.layer(layer)][0].mean;
}

/// The layer has this mean, and the test would see an error of a twentieth.
void check_mean(const RenderStatistics& picture, const std::string& layer, double expected) {
    check_mean_is(picture, layer, expected);
    for (const double planted : {0.95, 1.05}) CHECK_FALSE(mean_is(picture, layer, planted * expected).passed);
}

/// Every integrator that makes pictures of its own.
std::vector<std::string> integrators() {
    std::vector<std::string> result;
    for (const std::string& type : registry().types(Category::integrator))
        if (registry().find(Category::integrator, type)->parameters.size()) result.push_back(type);
    return result;
}

}  // namespace

TEST_CASE("the camera looks through lamps, which still cast shadows", "[hide_emitters]") {
    const auto scene = scene_from(floor_behind_lamp(), 4);
    for (const std::string& type : integrators()) {
        INFO(type);
        const auto hidden = render(*scene, type, true), shown = render(*scene, type, false, 16);
        CHECK(mean_of(hidden, "emission") == 0.0);
        check_mean(hidden, "direct", light_of_floor());
        CHECK(mean_of(shown, "emission") == Approx(5.0));
        CHECK(mean_of(shown, "direct") == 0.0);
    }
}

TEST_CASE("fog before and behind a hidden lamp dims alike", "[hide_emitters]") {
    const std::string fog =
        R"(<medium type="homogeneous"><float name="sigma_t" value="2"/><float name="albedo" value="0"/></medium>)";
    const auto scene = scene_from(floor_behind_lamp("", fog), 4);
    // Eye rays begin at the near clip plane, 0.01 m from the camera: 0.04 m to the lamp and 0.05 m behind it;
    // a path that skips either is brighter by 8 or 10 %, which check_mean() finds.
    const double expected = light_of_floor(2.0);
    for (const char* type : {"volpath", "mote_bdpt", "mote_upbp", "mote_vpl", "mote_ray_lights",
                             "mote_photon_map", "mote_single_scattering", "mote_epipolar"}) {
        INFO(type);
        const auto picture = render(*scene, type, true);
        CHECK(mean_of(picture, "emission") == 0.0);
        check_mean(picture, "direct", expected);
    }
}

// Mitsuba 3.9.1's volpath: a sheet that lets the eye's ray straight on is passed, and hides no less behind
// it. (Its path counts a sheet as a bounce and sees lamps behind it; every method here takes volpath's way.)
TEST_CASE("lamps are hidden behind panes as well", "[hide_emitters][long]") {
    struct Case {
        std::string bsdf;
        double passes;
    };
    const std::string black = R"(<bsdf type="diffuse"><rgb name="reflectance" value="0"/></bsdf>)";
    for (const auto& [bsdf, passes] :
         {Case{R"(<bsdf type="null"/>)", 1.0}, Case{R"(<bsdf type="thindielectric"/>)", passes_straight()},
          Case{R"(<bsdf type="mask"><float name="opacity" value="0.5"/>)" + black + "</bsdf>", 0.5}}) {
        const auto scene = scene_from(floor_behind_lamp(sheet(bsdf)), 4);
        for (const std::string& type : integrators()) {
            INFO(type << " " << bsdf);
            const auto hidden = render(*scene, type, true);
            CHECK(mean_of(hidden, "emission") == 0.0);
            check_mean(hidden, "direct", passes * light_of_floor());
            check_mean(render(*scene, type, false), "emission", passes * 5.0);
        }
    }
}

TEST_CASE("a pane shows the sky that it mirrors, not the sky behind it", "[hide_emitters]") {
    const auto scene =
        scene_from(R"(<scene version="3.0.0"><emitter type="constant"><rgb name="radiance" value="2"/>
        </emitter>)" + sheet(R"(<bsdf type="thindielectric"/>)") +
                       R"(<sensor type="orthographic"><transform name="to_world"><scale value="0.01"/>
        <lookat origin="0, 0, 0.1" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                   4);
    for (const std::string& type : integrators()) {
        INFO(type);
        // By chance R: passes for a standard error below 1 %.
        check_mean(render(*scene, type, true, 8 * passes), "emission", 2.0 * (1.0 - passes_straight()));
    }
}

TEST_CASE("the sky is hidden from the camera, not from mirrors", "[hide_emitters]") {
    const std::string sky = R"(<emitter type="constant"><rgb name="radiance" value="2"/></emitter>)";
    const auto alone = scene_from(
        "<scene version='3.0.0'><sensor type='perspective'/><shape type='sphere'>"
        "<transform name='to_world'><translate z='-9'/></transform></shape>" +
            sky + "</scene>",
        4);
    const auto mirror = scene_from(
        "<scene version='3.0.0'><sensor type='perspective'/><shape type='rectangle'>"
        "<transform name='to_world'><scale value='9'/><rotate y='1' angle='150'/>"
        "<translate z='3'/></transform><bsdf type='conductor'><string name='material' "
        "value='none'/></bsdf></shape>" +
            sky + "</scene>",
        4);
    for (const char* type : {"path", "volpath", "mote_bdpt", "mote_upbp", "mote_vpl", "mote_photon_map",
                             "mote_single_scattering"}) {
        INFO(type);
        CHECK(mean_of(render(*alone, type, true, 16), "emission") == 0.0);
        CHECK(mean_of(render(*alone, type, false, 16), "emission") == Approx(2.0));
        CHECK(mean_of(render(*mirror, type, true, 16), "emission") == Approx(2.0));
    }
}
