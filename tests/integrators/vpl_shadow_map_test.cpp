// mote_vpl with volumetric shadow maps against the same lights and eye paths traced: what it leaves of the
// light, what it takes of memory, what it refuses, and that nothing depends on threads.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include "core/objects/error.h"
#include "core/render/pass_runner.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"
#include "tests/support/temporary_folder.h"

using namespace mote;
using namespace mote::tests;

namespace {

std::shared_ptr<const core::Integrator> vpl(const std::string& visibility, int paths = 16) {
    return integrator_from(fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="{}"/>
        <float name="bound" value="4"/>{}</integrator>)",
                                       paths, visibility));
}

std::string shadow_map(int size, const std::string& more = "", int light_size = 16) {
    return fmt::format(R"(<visibility type="shadow_map"><integer name="size" value="{}"/>
        <integer name="light_size" value="{}"/>{}</visibility>)",
                       size, light_size, more);
}

double mean_of(const RenderStatistics& render, const std::string& layer) {
    const auto& channels = render.whole[render.layer(layer)];
    return (channels[0].mean + channels[1].mean + channels[2].mean) / 3.0;
}

/// Light of a layer with maps over that of the same layer traced, less one.
double bias_of(const RenderStatistics& maps, const RenderStatistics& traced, const std::string& layer) {
    return mean_of(maps, layer) / mean_of(traced, layer) - 1.0;
}

/// Renders with one set of lights and eye paths for every visibility: most of the noise is common to all.
RenderStatistics render(const core::Scene& scene, const std::string& visibility) {
    return render_statistics(scene, *vpl(visibility, 4), {4, 25, 5});
}

void check_bias(const core::Scene& scene, double bound) {
    const auto traced = render(scene, "");
    const auto coarse = render(scene, shadow_map(6)), fine = render(scene, shadow_map(48));
    for (const std::string layer : {"indirect_bounded", "multiple_scattering_bounded"}) {
        const double left = bias_of(fine, traced, layer), before = bias_of(coarse, traced, layer);
        INFO(layer << ": bias " << before << " at 6^2, " << left << " at 48^2");
        CHECK(std::fabs(left) < bound);
        CHECK(std::fabs(before) > 2.0 * std::fabs(left));
        // An error of 3 % more or less would be found.
        CHECK(std::fabs(bias_of(fine.scaled(1.03), traced, layer)) > bound);
        CHECK(std::fabs(bias_of(fine.scaled(0.97), traced, layer)) > bound);
    }
    CHECK(mean_of(fine, "direct") == mean_of(traced, "direct"));
}

core::PassImage first_pass(const core::Scene& scene, const core::Integrator& integrator, std::size_t threads,
                           core::Statistics* statistics = nullptr) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    core::Film film(scene.film().width, scene.film().height, integrator.layers(scene));
    core::PassRunner runner(scene, integrator, 3, film);
    const std::atomic<bool> cancelled = false;
    REQUIRE(runner.run_pass(cancelled));
    if (statistics) runner.estimator().add_statistics(*statistics);
    return runner.last_pass();
}

bool same(const core::PassImage& a, const core::PassImage& b) {
    for (std::size_t i = 0; i < a.layers(); ++i)
        if (!std::equal(a.layer(i).begin(), a.layer(i).end(), b.layer(i).begin())) return false;
    return true;
}

}  // namespace

TEST_CASE("shadow maps leave the light of VPLs as it is: fog", "[vpl][shadow_map]") {
    check_bias(*scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 8), 0.015);
}

TEST_CASE("shadow maps leave the light of VPLs as it is: smoke, glossy walls", "[vpl][shadow_map]") {
    const TemporaryFolder folder;
    // Connections are marched, not tracked: with the same lights and eye paths nothing is left to chance, and
    // what differs is what maps do.
    std::string smoke = smoke_medium(folder.file("smoke.vol"));
    const std::string type = R"(type="heterogeneous" name="interior">)";
    smoke.insert(smoke.find(type) + type.size(), R"(<string name="transmittance" value="ray_marching"/>)");
    check_bias(*scene_from(box(mixed, smoke), 8), 0.015);
}

TEST_CASE("lights on a pane that lets light through shine to both sides", "[vpl][shadow_map]") {
    std::string xml = box(grey, fog("0.8, 1.0, 1.3", ""));
    xml.insert(xml.find("<sensor"), R"(<shape type="rectangle"><transform name="to_world"><scale value="0.6"/>
        <rotate x="1" angle="80"/><translate y="0.4"/></transform>
        <bsdf type="roughdielectric"><float name="alpha" value="0.4"/></bsdf></shape>)");
    check_bias(*scene_from(xml, 8), 0.02);
}

TEST_CASE("maps of the lights leave single scattering as it is", "[vpl][shadow_map]") {
    const std::string lights[] = {
        R"(<emitter type="point"><point name="position" x="0.4" y="0.5" z="1.6"/></emitter>)",
        R"(<emitter type="spot"><rgb name="intensity" value="6"/><float name="cutoff_angle" value="35"/>
            <transform name="to_world"><lookat origin="0.2, 1, 3.5" target="0, -0.5, 0" up="0, 1, 0"/></transform></emitter>)",
        R"(<emitter type="directional"><vector name="direction" x="-0.3" y="-0.5" z="-1"/></emitter>)"};
    const TemporaryFolder folder;
    for (const std::string& light : lights) {
        const std::string xml =
            with(without_area_light(box(grey, smoke_medium(folder.file("smoke.vol")))), light);
        const auto scene = scene_from(xml, 8);
        const auto traced = render_statistics(*scene, *vpl("", 1), {4, 1200, 5});
        const auto maps = render_statistics(*scene, *vpl(shadow_map(4, "", 96), 1), {4, 1200, 5});
        const double bias = bias_of(maps, traced, "single_scattering");
        INFO(light << ": bias " << bias);
        CHECK(std::fabs(bias) < 0.015);
        CHECK(std::fabs(bias_of(maps.scaled(1.04), traced, "single_scattering")) > 0.015);
    }
}

TEST_CASE("a pass with shadow maps is the same bits whatever threads and batches", "[vpl][shadow_map]") {
    const TemporaryFolder folder;
    const auto scene = scene_from(box(mixed, smoke_medium(folder.file("smoke.vol"))), 24);
    const std::string three = R"(<integer name="maps" value="3"/>)";
    const auto one = first_pass(*scene, *vpl(shadow_map(12)), 1);
    CHECK(same(one, first_pass(*scene, *vpl(shadow_map(12)), 4)));
    CHECK(same(one, first_pass(*scene, *vpl(shadow_map(12, three)), 4)));
    CHECK_FALSE(same(one, first_pass(*scene, *vpl(shadow_map(13)), 4)));
}

TEST_CASE("shadow maps take the memory of a handful, whatever the number of VPLs", "[vpl][shadow_map]") {
    const auto scene = scene_from(box(grey, fog("1", "")), 16);
    core::Statistics few, many;
    first_pass(*scene, *vpl(shadow_map(8), 4), 4, &few);
    first_pass(*scene, *vpl(shadow_map(8), 800), 4, &many);
    CHECK(few.values["shadow_maps_built"] < 40.0);
    CHECK(many.values["shadow_maps_built"] > 1000.0);
    CHECK(many.values["shadow_map_bytes"] == few.values["shadow_map_bytes"]);
    lights::ShadowMapSettings settings;
    CHECK(many.values["shadow_map_bytes"] == 4.0 * double(settings.bytes(8, false)));
    CHECK(many.values["receiver_bytes_peak"] == few.values["receiver_bytes_peak"]);
    CHECK(many.values["receivers"] > 200.0);
    // At most three receivers a pixel: the surface, and two of its scattering points.
    CHECK(many.values["receiver_bytes_peak"] < 100.0 * 256.0 * 1.5 * 3.0);
}

TEST_CASE("a shadow map above its limit is refused, with file, line and the size that fits",
          "[vpl][shadow_map]") {
    const auto scene = scene_from(box(grey, fog("1", "")), 8);
    const auto integrator = vpl("\n\n" + shadow_map(512, R"(<float name="max_megabytes" value="1"/>)"));
    try {
        integrator->prepare(*scene, {});
        FAIL("it was not refused");
    } catch (const core::InputError& error) {
        CHECK_THAT(error.what(), ContainsSubstring("512 x 512") && ContainsSubstring("100 x 100 would fit"));
        CHECK(error.where().line == 4);
    }
    CHECK_NOTHROW(vpl(shadow_map(100, R"(<float name="max_megabytes" value="1"/>)"))->prepare(*scene, {}));
    for (const std::string wrong :
         {"size=\"", R"(<integer name="maps" value="0"/>)", R"(<string name="storage" value="interval"/>)"})
        CHECK_THROWS_AS(vpl(shadow_map(8, wrong)), core::InputError);
}

TEST_CASE("without media shadow maps have no effect", "[vpl][shadow_map]") {
    const auto scene = scene_from(box(grey, ""), 8);
    core::Statistics statistics;
    CHECK(same(first_pass(*scene, *vpl(""), 2), first_pass(*scene, *vpl(shadow_map(8)), 2, &statistics)));
    CHECK(statistics.values.count("shadow_maps_built") == 0);
    REQUIRE(statistics.warnings.size() == 1);
    CHECK_THAT(statistics.warnings[0], ContainsSubstring("no effect"));
    const auto plan = vpl(shadow_map(8))->plan(*scene, core::find_requirements(*scene));
    CHECK_THAT(plan.to_text(), ContainsSubstring("no effect"));
}

TEST_CASE("the plan compares receivers with texels", "[vpl][shadow_map]") {
    const auto scene = scene_from(box(grey, fog("0.8, 1.0, 1.3", "")), 64);
    const auto text = [&](const std::string& visibility) {
        return vpl(visibility)->plan(*scene, core::find_requirements(*scene)).to_text();
    };
    CHECK_THAT(text(""), ContainsSubstring("shadow rays"));
    CHECK_THAT(text(shadow_map(24)), ContainsSubstring("24^2") && ContainsSubstring("biased") &&
                                         ContainsSubstring("4096 receivers a pass against 576 texels") &&
                                         ContainsSubstring("they pay") && ContainsSubstring("MB"));
    CHECK_THAT(text(shadow_map(64)), ContainsSubstring("tracing is cheaper here"));
}
