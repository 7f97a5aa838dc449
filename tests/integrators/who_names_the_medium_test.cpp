// One fog, declared in every way that the scene language has: as the inside of a shape, as the outside of
// one, by the sensor, by the light; and seen from inside, across its border, and from outside. Every method
// that walks through media must render the same transport: bounded VPLs that of volpath with vpl_bound, by
// rays and by maps, exact compensation brings back the rest, marching has volpath's mean, epipolar lines
// follow marching.
#include <fmt/format.h>

#include "core/render/pass_runner.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::tests;

namespace {

enum class Namer { interior, exterior, sensor, light };
enum class Eye { inside, across, outside };
enum class Lamp { point, globe };
constexpr Eye eyes[] = {Eye::inside, Eye::across, Eye::outside};

std::string text(Namer n) {
    constexpr const char* names[] = {"interior", "exterior", "sensor", "light"};
    return names[int(n)];
}
std::string text(Eye e) {
    constexpr const char* names[] = {"inside", "across", "outside"};
    return names[int(e)];
}

std::string fog_named(const std::string& name) {
    return fmt::format(R"(<ref {}id="fog"/>)", name.empty() ? "" : "name=\"" + name + "\" ");
}

/// Two walls and a lamp in fog. The fog fills a sphere of radius 3 around them, or everything but a bubble of
/// radius 3 in which a camera that sees from outside stands; a camera across the border has a plane through
/// it.
std::string scene_of(Namer namer, Eye eye, Lamp lamp) {
    const bool filled = namer == Namer::interior;  // a shape around the fog, not around what has none
    std::string xml = R"(<scene version="3.0.0">
        <medium type="homogeneous" id="fog"><rgb name="sigma_t" value="0.25, 0.3, 0.4"/>
            <rgb name="albedo" value="0.9, 0.8, 0.7"/></medium>
        <medium type="homogeneous" id="nothing"><rgb name="sigma_t" value="0"/></medium>)";
    const auto wall = [&](const std::string& transform) {
        xml += R"(<shape type="rectangle"><transform name="to_world">)" + transform + "</transform>" + grey +
               "</shape>";
    };
    wall(R"(<translate z="-1"/>)");
    wall(R"(<translate z="-1"/><rotate x="1" angle="-90"/>)");
    // A light says which medium it stands in, where it is the one to say so: a faint one beside the globe.
    // Near a point in fog 1/d^2 has no variance: what is sampled at collisions is lit by a globe instead.
    const std::string lit_in = namer == Namer::light ? fog_named("") : "";
    if (lamp == Lamp::point)
        xml += R"(<emitter type="point"><point name="position" x="0.4" y="0.5" z="0.3"/>
            <rgb name="intensity" value="4, 3, 2"/>)" +
               lit_in + "</emitter>";
    else
        xml += R"(<shape type="sphere"><point name="center" x="0.4" y="0.5" z="0.3"/>
            <float name="radius" value="0.25"/><emitter type="area"><rgb name="radiance" value="20, 15, 10"/>
            </emitter></shape><emitter type="point"><point name="position" x="-9" y="9" z="-9"/>
            <rgb name="intensity" value="1e-6"/>)" +
               lit_in + "</emitter>";
    if (filled)
        xml += R"(<shape type="sphere"><float name="radius" value="3"/><bsdf type="null"/>)" +
               fog_named("interior") + "</shape>";
    else
        xml += fmt::format(
            R"(<shape type="sphere"><point name="center" x="0" y="0" z="{}"/><float name="radius" value="3"/>
            <bsdf type="null"/><ref name="interior" id="nothing"/>{}</shape>)",
            eye == Eye::inside ? 20 : 5, namer == Namer::exterior ? fog_named("exterior") : "");
    const std::string named = namer == Namer::sensor ? fog_named("") : "";
    // The fog's border lies at z = 3, or at z = 2 before the bubble.
    const double z = eye == Eye::inside ? 1.5 : eye == Eye::outside ? 4.5 : filled ? 2.6 : 2.4;
    if (eye == Eye::across)
        xml += fmt::format(R"(<sensor type="orthographic"><transform name="to_world"><scale x="2.4" y="2.4"/>
            <lookat origin="0, 0, {0}" target="0, 0, 0" up="0, 1, 0"/></transform>{1}</sensor>)",
                           z, named);
    else
        xml += fmt::format(
            R"(<sensor type="perspective"><float name="fov" value="{}"/><transform name="to_world">
            <lookat origin="0, 0, {}" target="0, 0, 0" up="0, 1, 0"/></transform>{}</sensor>)",
            eye == Eye::inside ? 60 : 30, z, named);
    return xml + "</scene>";
}

/// Runs `check(scene)` for a fog in a shape and one around everything. That it makes no difference which of
/// the others names the latter is a matter of bits: see the first test.
template <typename Check>
void for_every_telling(Lamp lamp, const Check& check) {
    for (const Namer namer : {Namer::interior, Namer::sensor})
        for (const Eye eye : eyes) {
            INFO("fog named by " << text(namer) << ", seen from " << text(eye));
            check(*scene_from(scene_of(namer, eye, lamp), 8));
        }
}

RenderStatistics render(const core::Scene& scene, const std::string& integrator, std::uint32_t passes,
                        std::uint64_t seed) {
    RenderSpec spec{4, passes, seed};
    if (integrator.find("compensation") != std::string::npos) {
        spec.sums.push_back({"all_indirect", {"indirect_bounded", "compensation_surface"}});
        spec.sums.push_back({"all_multiple", {"multiple_scattering_bounded", "compensation_volume"}});
    }
    return render_statistics(scene, *integrator_from(integrator), spec);
}

std::string vpl(const std::string& nested, int paths = 16) {
    return fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>
        <float name="bound" value="1"/>{}</integrator>)",
                       paths, nested);
}

/// Checks that all layers have equal expectations, with the power to see an error of `power`.
void check_same(const RenderStatistics& a, const RenderStatistics& b,
                const std::vector<std::pair<std::string, std::string>>& layers, double power) {
    CHECK(a.non_finite == 0);
    for (const auto& [of_a, of_b] : layers) {
        check_same_mean(a, of_a, b, of_b, {1.0 + power, 1.0 - power});
    }
}

double mean_of(const RenderStatistics& render, const std::string& layer) {
    const auto& channels = render.whole[render.layer(layer)];
    return (channels[0].mean + channels[1].mean + channels[2].mean) / 3.0;
}

}  // namespace

TEST_CASE("one name is as good as another, to the bit, in every integrator", "[naming]") {
    for (const Eye eye : eyes)
        for (const std::string& type : registry().types(core::Category::integrator)) {
            if (type == "mote_vsl" || type == "mote_vpl_ray_bundles" || type == "mote_ray_bundles" ||
                type == "mote_micro_rendering")
                continue;  // surfaces only
            // Their defaults trace more light than bits need.
            const std::string few =
                type == "mote_vpl" || type == "mote_ray_lights" ? R"(<integer name="paths" value="8"/>)"
                : type == "mote_photon_map" ? R"(<integer name="photon_paths" value="200"/>)"
                                            : "";
            const auto integrator =
                integrator_from("<integrator type=\"" + type + "\">" + few + "</integrator>");
            std::vector<core::PassImage> pictures;
            for (const Namer namer : {Namer::sensor, Namer::light, Namer::exterior}) {
                const auto scene = scene_from(scene_of(namer, eye, Lamp::point), 8);
                core::Film film(8, 8, integrator->layers(*scene));
                core::PassRunner runner(*scene, *integrator, 3, film);
                const std::atomic<bool> cancelled = false;
                REQUIRE(runner.run_pass(cancelled));
                pictures.push_back(runner.last_pass());
            }
            for (std::size_t i = 0; i < pictures[0].layers(); ++i) {
                INFO(type << " seen from " << text(eye) << ", layer " << i);
                const auto sensor = pictures[0].layer(i);
                CHECK(std::equal(sensor.begin(), sensor.end(), pictures[1].layer(i).begin()));
                CHECK(std::equal(sensor.begin(), sensor.end(), pictures[2].layer(i).begin()));
            }
        }
}

TEST_CASE("bounded VPLs equal bounded paths, whatever names the fog", "[vpl][equality][naming]") {
    for_every_telling(Lamp::globe, [](const core::Scene& scene) {
        const auto reference =
            render(scene, R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)",
                   6000, 12);
        check_same(render(scene, vpl(""), 600, 11), reference,
                   {{"direct", "direct"},
                    {"single_scattering", "single_scattering"},
                    {"indirect_bounded", "indirect_bounded"},
                    {"multiple_scattering_bounded", "multiple_scattering_bounded"}},
                   0.15);
    });
}

TEST_CASE("bidirectional paths equal volpath, whatever names the fog", "[bdpt][equality][naming]") {
    for_every_telling(Lamp::globe, [](const core::Scene& scene) {
        check_same(render(scene, R"(<integrator type="mote_bdpt"/>)", 250, 21),
                   render(scene, R"(<integrator type="volpath"/>)", 1500, 22),
                   {{"direct", "direct"},
                    {"single_scattering", "single_scattering"},
                    {"indirect", "indirect"},
                    {"multiple_scattering", "multiple_scattering"}},
                   0.3);
    });
}

TEST_CASE("VPLs with maps equal those by rays, whatever names the fog", "[vpl][shadow_map][naming]") {
    // Lights and eye paths are the same; the interpolation error of maps is below 2 % here
    // (docs/methods/media.md).
    const std::string maps = R"(<visibility type="shadow_map"><integer name="size" value="32"/>
        <integer name="light_size" value="32"/></visibility>)";
    for_every_telling(Lamp::point, [&](const core::Scene& scene) {
        const auto traced = render(scene, vpl("", 6), 30, 5), mapped = render(scene, vpl(maps, 6), 30, 5);
        for (const std::string layer : {"indirect_bounded", "multiple_scattering_bounded"}) {
            INFO(layer << ": " << mean_of(mapped, layer) << " by maps, " << mean_of(traced, layer)
                       << " by rays");
            CHECK(mean_of(traced, layer) > 1e-3);
            CHECK(std::fabs(mean_of(mapped, layer) / mean_of(traced, layer) - 1.0) < 0.02);
        }
    });
}

TEST_CASE("exact compensation brings all light back, whatever names the fog",
          "[compensation][equality][naming]") {
    for_every_telling(Lamp::globe, [](const core::Scene& scene) {
        check_same(render(scene, vpl(R"(<compensation type="exact"/>)"), 300, 13),
                   render(scene, R"(<integrator type="volpath"/>)", 2500, 14),
                   {{"all_indirect", "indirect"}, {"all_multiple", "multiple_scattering"}}, 0.2);
    });
}

TEST_CASE("marching has volpath's mean, whatever names the fog", "[epipolar][equality][naming]") {
    for_every_telling(Lamp::point, [](const core::Scene& scene) {
        check_same(render(scene, R"(<integrator type="mote_single_scattering"/>)", 200, 15),
                   render(scene, R"(<integrator type="volpath"><integer name="max_depth" value="3"/>
                       <boolean name="equiangular" value="true"/></integrator>)",
                          3000, 16),
                   {{"direct", "direct"}, {"single_scattering", "single_scattering"}}, 0.1);
    });
}

TEST_CASE("photon maps have volpath's direct light, whatever names the fog",
          "[photon_map][equality][naming]") {
    for_every_telling(Lamp::globe, [](const core::Scene& scene) {
        check_same(
            render(scene, R"(<integrator type="mote_photon_map">
            <integer name="photon_paths" value="100"/></integrator>)",
                   400, 17),
            render(scene, R"(<integrator type="volpath"><integer name="max_depth" value="3"/></integrator>)",
                   1500, 18),
            {{"direct", "direct"}, {"single_scattering", "single_scattering"}}, 0.15);
    });
}

TEST_CASE("epipolar lines follow full rate, whatever names the fog", "[epipolar][naming]") {
    // Lines as dense as pixels march or interpolate next to nothing: what is left is below a hundredth.
    const std::string lines =
        R"(<integrator type="mote_epipolar"><integer name="lines" value="256"/></integrator>)";
    for (const Namer namer : {Namer::interior, Namer::sensor})
        for (const Eye eye : eyes) {
            INFO("fog named by " << text(namer) << ", seen from " << text(eye));
            const auto scene = scene_from(scene_of(namer, eye, Lamp::point), 32);
            const auto full = render(*scene, R"(<integrator type="mote_single_scattering"/>)", 2, 3),
                       epipolar = render(*scene, lines, 2, 3);
            const double there = mean_of(full, "single_scattering");
            CHECK(there > 1e-3);
            CHECK(std::fabs(mean_of(epipolar, "single_scattering") / there - 1.0) < 0.01);
        }
}
