// Light lists of `mote_vpl`: lists hold the lights that rays find, the mean is that of all lights however
// many of them a list misses, and what is hidden costs few rays.
#include <bit>

#include "core/render/pass_runner.h"
#include "core/scene/scene.h"
#include "integrators/virtual_point_lights/vpl_light_lists.h"
#include "lights/shadow_maps/shadow_map_gather.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "lights/virtual_lights/vpl_choice.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;
using namespace mote::tests;

namespace {

std::string vpl(int lists) {
    return fmt::format(R"(<integrator type="mote_vpl"><integer name="paths" value="16"/>
        <float name="bound" value="1"/><integer name="light_lists" value="{}"/></integrator>)",
                       lists);
}

bool listed(const std::vector<std::uint64_t>& list, std::size_t light) {
    return list[light / 64] >> (light % 64) & 1;
}

/// The box with a wall across it, which leaves a slit at the top.
std::string two_rooms() {
    std::string xml = box(grey, "");
    xml.insert(xml.find("<sensor"),
               R"(<shape type="cube"><transform name="to_world"><scale x="0.02" y="0.9" z="1"/>
        <translate x="-0.3" y="-0.1"/></transform>)" +
                   grey + "</shape>");
    return xml;
}

}  // namespace

TEST_CASE("Lights that are not listed are drawn evenly and make up for the others", "[vpl][light_lists]") {
    const std::vector<std::uint64_t> list{0x00ff00f0ull, 0x5ull};
    for (const lights::VplRange& range : {lights::VplRange{}, lights::VplRange{3, 5}}) {
        std::vector<double> weight(100, 0.0);
        for (std::size_t offset = 0; offset < 4; ++offset)
            lights::ListedVpls{range, list, 4, offset}.for_each(100, [&](const lights::WeightedVpl& light) {
                weight[light.index] += 0.25 * double(light.weight);
                CHECK(light.weight == (listed(list, light.index) ? 1.0f : 4.0f));
            });
        for (std::size_t j = 0; j < 100; ++j) CHECK(weight[j] == (range.contains(j) ? 1.0 : 0.0));
    }
}

TEST_CASE("Light lists hold the lights whose rays meet an item", "[vpl][light_lists]") {
    const auto scene = scene_from(two_rooms(), 8);
    const auto vpls = lights::trace_light_paths(*scene, {.paths = 200}, 1, 0, SamplerKind::sobol);
    const LightListSettings settings{.size = 8};
    const SurfaceItems items(scene->rays().bounds(), settings.cells);
    const VplLightLists lists(*scene, items, vpls, settings, {});
    REQUIRE(vpls.lights.size() > 300);  // more than one batch
    CHECK(lists.rays().closest == vpls.lights.size() * 64);
    std::vector<std::vector<std::uint64_t>> expected(items.count(),
                                                     std::vector<std::uint64_t>(lists.words()));
    for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
        const auto view = lights::views_of(vpls, j, settings.size).view[0];
        for (int texel = 0; texel < 64; ++texel)
            if (const auto hit = scene->first_hit(view.ray(texel))) {
                const bool front = glm::dot(hit->geometric_normal, view.ray(texel).direction) < 0.0f;
                const Vec3 normal = front ? hit->geometric_normal : -hit->geometric_normal;
                expected[items.item(hit->position, normal)][j / 64] |= std::uint64_t(1) << (j % 64);
            }
    }
    std::size_t wrong = 0, bits = 0;
    for (std::size_t item = 0; item < items.count(); ++item) {
        std::vector<std::uint64_t> list(lists.words());
        lists.add(item, list);
        wrong += list != expected[item];
        for (const std::uint64_t word : list) bits += std::size_t(std::popcount(word));
    }
    CHECK(wrong == 0);
    CHECK(bits > 0);
}

TEST_CASE("Items part surfaces by place and normal, also where there is nothing", "[vpl][light_lists]") {
    const SurfaceItems items({Vec3(-1.0f), Vec3(1.0f, 3.0f, 0.0f)}, 8);
    CHECK(items.count() == 6 * 4 * 8 * 2);
    CHECK(items.item(Vec3(0.1f), Vec3(0, 1, 0)) != items.item(Vec3(0.1f), Vec3(0, -1, 0)));
    CHECK(items.item(Vec3(0.1f), Vec3(0, 1, 0)) != items.item(Vec3(0.1f, 0.7f, 0.1f), Vec3(0, 1, 0)));
    for (const Vec3& p : {Vec3(-1e30f), Vec3(1e30f), Vec3(1.0f, 3.0f, 0.0f)})
        CHECK(items.item(p, Vec3(-1, 0, 0)) < items.count());
    for (const Bounds3& bounds : {Bounds3{}, Bounds3{Vec3(1.0f), Vec3(1.0f)}}) {
        const SurfaceItems one(bounds, 8);
        CHECK(one.count() == 6);
        CHECK(one.item(Vec3(2.0f), Vec3(0, 0, -1)) == 5);
    }
}

TEST_CASE("VPLs by lists have the mean of volpath, with fog and without", "[vpl][light_lists][equality]") {
    for (const std::string& medium : {std::string(), fog("0.8, 1.0, 1.3", "")}) {
        const auto scene = scene_from(medium.empty() ? two_rooms() : box(grey, medium), 8);
        const auto reference = render_statistics(
            *scene,
            *integrator_from(
                R"(<integrator type="volpath"><float name="vpl_bound" value="1"/></integrator>)"),
            {4, 1200, 2});
        // Four directions a light: most of what it sees is missed.
        const auto render = render_statistics(*scene, *integrator_from(vpl(2)), {4, 500, 5});
        const ZTest test = same_mean(render, "indirect_bounded", reference, "indirect_bounded");
        INFO(test.report);
        CHECK(test.passed);
        CHECK_FALSE(same_mean(render.scaled(1.15), "indirect_bounded", reference, "indirect_bounded").passed);
    }
}

TEST_CASE("Lists save rays where walls hide lights, and the picture is the same within noise",
          "[vpl][light_lists]") {
    const auto scene = scene_from(two_rooms(), 24);
    const auto rays = [&](int lists) {
        const auto method = integrator_from(vpl(lists));
        Film film(24, 24, method->layers(*scene));
        PassRunner runner(*scene, *method, 3, film);
        const std::atomic<bool> cancelled = false;
        REQUIRE(runner.run_pass(cancelled));
        Statistics statistics;
        runner.estimator().add_statistics(statistics);
        return double(statistics.rays.at("occlusion"));
    };
    CHECK(rays(8) < 0.8 * rays(0));
}
