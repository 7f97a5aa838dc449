// The two forms of the path tracer, a wavefront and packets, follow the same paths: they use the same random
// numbers and differ in rounding alone.
#include <cmath>

#include "core/render/render_driver.h"
#include "integrators/path_tracing/guided_paths.h"
#include "integrators/path_tracing/wavefront.h"
#include "tests/integrators/paths_of_a_pass.h"
#include "tests/integrators/test_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::integrators;
using namespace mote::tests;

namespace {

constexpr int size = 16, pixels = size * size, passes = 16;

/// A room of several materials with a lamp, more lights, and a ball with smooth normals' frame.
std::string furnished(const std::string& wall, const std::string& more) { return with(box(wall, ""), more); }

const std::string glass_ball = R"(<shape type="sphere"><float name="radius" value="0.3"/>
    <point name="center" x="-0.4" y="-0.6" z="0.1"/><bsdf type="dielectric"/></shape>)";
const std::string textured_card = R"(<shape type="rectangle"><transform name="to_world"><scale value="0.4"/>
    <translate x="0.4" y="0.1" z="-0.9"/></transform><bsdf type="twosided"><bsdf type="diffuse">
    <texture name="reflectance" type="checkerboard"/></bsdf></bsdf></shape>)";
const std::string matt_ball = R"(<shape type="sphere"><float name="radius" value="0.25"/>
    <point name="center" x="0.5" y="0.5" z="0"/><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.6, 0.4"/></bsdf></shape>)";
const std::string more_lights = R"(<emitter type="point"><point name="position" x="0" y="0" z="3"/>
    <rgb name="intensity" value="2, 3, 4"/></emitter><emitter type="constant"><rgb name="radiance" value="0.3, 0.2, 0.1"/></emitter>
    <shape type="sphere"><float name="radius" value="0.1"/><point name="center" x="-0.6" y="0.4" z="0"/>
    <emitter type="area"><rgb name="radiance" value="3, 6, 9"/></emitter></shape>)";

struct Comparison {
    int paths = 0, differ = 0;
    double wavefront = 0.0, packets = 0.0;  ///< sums
};

bool near(const Rgb& a, const Rgb& b) {
    for (int c = 0; c < 3; ++c)
        if (!(std::fabs(a[c] - b[c]) <= 1e-3f * (std::fabs(a[c]) + std::fabs(b[c])) + 1e-6f)) return false;
    return true;
}

void compare_sums(TransportSum a, TransportSum b, Comparison& found) {
    bool same = true;
    for (std::size_t layer = 0; layer < transport_count; ++layer) {
        same &= near(a.light[layer], b.light[layer]);
        found.wavefront += double(average(a.light[layer])), found.packets += double(average(b.light[layer]));
    }
    ++found.paths, found.differ += !same;
}

Comparison compare(const Scene& scene, const EyePathLimits& limits, const lights::ScatteringGuide& guide) {
    const RenderOptions options{.seed = 7, .width = size, .height = size};
    const PathSettings settings{limits};
    REQUIRE(WavefrontScene::suits(scene, settings));
    const WavefrontScene shared(scene, limits);
    const auto filter = make_pixel_filter("box", 0.5f, 0.5f);
    const std::atomic<bool> cancelled{false};
    WalkContext walk;
    const auto wavefront = std::make_unique<Wavefront>(shared, walk, guide);
    const auto packet =
        std::make_unique<EyePacket<false>>(scene, EyePacketSettings{.limits = limits, .guide = guide}, walk);
    Comparison found;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        const PassContext context{pass, *filter, cancelled};
        wavefront->clear();
        for (int i = 0; i < pixels; ++i)
            wavefront->start(make_eye_ray(scene, options, context, i % size, i / size));
        wavefront->run();
        for_each_path(scene, settings, options, context, *packet, [&](int pixel, const TransportSum& sum) {
            compare_sums(wavefront->sum(pixel), sum, found);
        });
    }
    return found;
}

/// A rounding that makes a ray meet another surface, or a path survive, changes a path: less than one in a
/// hundred does.
void check_same(const Scene& scene, const EyePathLimits& limits, const lights::ScatteringGuide& guide) {
    const Comparison found = compare(scene, limits, guide);
    INFO(found.differ << " of " << found.paths << " paths differ; " << found.wavefront << " against "
                      << found.packets);
    CHECK(found.packets > 0.0);
    CHECK(found.differ * 100 < found.paths);
}
void check_same(const std::string& xml, const EyePathLimits& limits = {}) {
    const auto scene = scene_from(xml, size);
    for (const int samples : {1, 2}) {
        EyePathLimits sampled = limits;
        sampled.light_samples.surfaces = samples;
        check_same(*scene, sampled, lights::no_guide());
    }
}

}  // namespace

TEST_CASE("a wavefront follows the paths of packets", "[integrators]") {
    check_same(box(grey, ""));
    check_same(box(glossy, ""));
    check_same(furnished(grey, glass_ball + textured_card + matt_ball));
    check_same(furnished(grey, more_lights + matt_ball));
    check_same(furnished(mixed, more_lights + glass_ball + textured_card));
}

TEST_CASE("a wavefront ends where limits say so", "[integrators]") {
    const std::string xml = furnished(grey, glass_ball + more_lights);
    check_same(xml, {.max_depth = 2});
    check_same(xml, {.max_depth = 4, .rr_depth = 1});
    check_same(xml, {.max_scatterings = 2});
    check_same(xml, {.wanted = Transport::direct});
    check_same(xml, {.wanted = Transport::indirect});
    check_same(xml, {.wanted = Transport::emission | Transport::indirect});
}

TEST_CASE("a wavefront of guided paths follows those of packets", "[integrators][guiding]") {
    for (const std::string& xml : {furnished(grey, textured_card + matt_ball),
                                   furnished(mixed, more_lights + glass_ball + textured_card)}) {
        const auto scene = scene_from(xml, size);
        const RenderOptions options{.seed = 7, .width = size, .height = size};
        PathSettings settings;
        settings.guiding = {.mode = Guiding::on, .passes = 7, .paths = 4096, .leaf_samples = 500.0};
        SharedCounters counters;
        const GuideTraining<false> training(*scene, options, settings, 1.6, counters);
        const lights::LearnedGuide* const guide = training.guide();
        REQUIRE_FALSE(guide->surfaces().at(Vec3(0.0f)).empty);
        check_same(*scene, {}, *guide);
        check_same(*scene, {.light_samples = {2, 1}}, *guide);
    }
}
