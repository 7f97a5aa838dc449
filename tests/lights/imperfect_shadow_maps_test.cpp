// Imperfect shadow maps: points lie evenly on surfaces, holes are filled, closed walls keep light in, and
// answers are those of shadow rays but for a stated fraction, near the light and far from it.
#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"

#include <tbb/global_control.h>

#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/scene.h"
#include "lights/virtual_lights/particle_tracer.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::lights;
using namespace mote::tests;

namespace {

const std::string grey = R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)";

std::string cube(const std::string& transform) {
    return R"(<shape type="cube"><transform name="to_world">)" + transform + "</transform>" + grey +
           "</shape>";
}
std::unique_ptr<Scene> room(const std::string& inside) {
    return scene_from(R"(<scene version="3.0.0">)" + cube(R"(<scale value="2"/>)") + inside +
                      R"(<emitter type="point"><point name="position" x="0.3" y="1.5" z="-0.2"/></emitter>
        <sensor type="perspective"/></scene>)");
}
/// Blocks on the floor, a thin table, a ball.
std::unique_ptr<Scene> furnished() {
    return room(
        cube(
            R"(<scale x="0.4" y="0.7" z="0.4"/><rotate y="1" angle="30"/><translate x="-0.9" y="-1.3" z="0.2"/>)") +
        cube(R"(<scale x="0.7" y="0.03" z="0.4"/><translate x="0.9" y="-0.8" z="-0.6"/>)") +
        R"(<shape type="sphere"><float name="radius" value="0.4"/><point name="center" x="0.6" y="0.4" z="0.9"/>)" +
        grey + "</shape>");
}

/// Receivers on surfaces all over the scene, seen from random points in the room.
std::vector<SurfaceHit> receivers(const Scene& scene, int count) {
    std::vector<SurfaceHit> hits;
    Rng rng(5);
    while (int(hits.size()) < count) {
        const Vec3 from(3.8f * rng.next_float() - 1.9f, 3.8f * rng.next_float() - 1.9f,
                        3.8f * rng.next_float() - 1.9f);
        if (const auto hit = scene.first_hit({from, square_to_sphere(rng.next_vec2())})) hits.push_back(*hit);
    }
    return hits;
}

struct Wrong {
    double near = 0.0, far = 0.0;  ///< fractions of the pairs closer than 1 m, and of all others
    double lit = 0.0;              ///< of wrong answers, how many say that there is light
};

/// Wrong answers over all pairs of lights and receivers that face each other.
Wrong wrong_answers(const Scene& scene, const ImperfectMapSettings& settings) {
    const VplSet vpls = trace_light_paths(scene, {.paths = 60, .max_vertices = 2}, 3, 0, SamplerKind::sobol);
    ImperfectShadowMaps maps;
    maps.build(sample_surfaces(scene, std::size_t(settings.all_points), 1), vpls, settings, 7);
    double near_pairs = 0.0, far_pairs = 0.0, wrong_lit = 0.0;
    Wrong wrong;
    for (const SurfaceHit& hit : receivers(scene, 400))
        for (std::size_t j = 0; j < vpls.lights.size(); ++j) {
            const VirtualPointLight& vpl = vpls.lights[j];
            const Vec3 to_light = vpl.position - hit.position;
            const Vec3 n = glm::dot(hit.geometric_normal, to_light) > 0.0f ? hit.geometric_normal
                                                                           : -hit.geometric_normal;
            if (glm::dot(vpl.normal, to_light) >= 0.0f) continue;
            const Vec3 from = offset_origin(hit, n), d = vpl.position - from;
            const bool truth = scene.visible({from, d, 0.0f, 0.9999f});
            const bool answer = maps.visible(j, from);
            const bool near = glm::length(d) < 1.0f;
            (near ? near_pairs : far_pairs) += 1.0;
            (near ? wrong.near : wrong.far) += truth != answer;
            wrong_lit += answer && !truth;
        }
    wrong.lit = wrong_lit / std::max(wrong.near + wrong.far, 1.0);
    wrong.near /= near_pairs, wrong.far /= far_pairs;
    return wrong;
}

/// Fraction of receivers on the walls of the room that a light within a closed box reaches.
double leak(const ImperfectMapSettings& settings) {
    const auto scene = room(cube(R"(<scale x="0.5" y="0.6" z="0.4"/><rotate y="1" angle="20"/>)"));
    VplSet vpls;
    Rng rng(9);
    for (int j = 0; j < 30; ++j) {
        VirtualPointLight vpl;  // as in a medium
        vpl.position = 0.6f * (Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 0.5f);
        vpls.lights.push_back(vpl);
    }
    ImperfectShadowMaps maps;
    maps.build(sample_surfaces(*scene, std::size_t(settings.all_points), 1), vpls, settings, 7);
    double reached = 0.0, pairs = 0.0;
    for (const SurfaceHit& hit : receivers(*scene, 400)) {
        if (max_component(glm::abs(hit.position)) < 1.99f) continue;
        for (std::size_t j = 0; j < vpls.lights.size(); ++j, pairs += 1.0)
            reached += maps.visible(j, hit.position);
    }
    return reached / pairs;
}

}  // namespace

TEST_CASE("Points lie on surfaces, evenly by area", "[imperfect_shadow_maps]") {
    const auto scene = room(R"(<shape type="sphere"><float name="radius" value="0.7"/>)" + grey + "</shape>");
    const SurfaceSamples points = sample_surfaces(*scene, 40000, 3);
    REQUIRE(points.points.size() == 40000);
    const double ball = 4.0 * pi * 0.49, area = ball + 96.0;
    CHECK(points.density == Approx(40000.0 / area).epsilon(0.02));
    CHECK(points.radius(10000, 3.0f) == Approx(std::sqrt(3.0 * area / (pi * 10000.0))).epsilon(0.01));
    double on_ball = 0.0, wall = 0.0, first = 0.0;
    for (std::size_t i = 0; i < points.points.size(); ++i) {
        const SurfaceSample& p = points.points[i];
        const bool round = glm::length(p.position) < 1.0f;
        CHECK(std::fabs(round ? glm::length(p.position) - 0.7f : max_component(glm::abs(p.position)) - 2.0f) <
              1e-4f);
        on_ball += round, wall += p.position.x > 1.999f;
        first += i < 10000 && round;  // any range is a sample
    }
    const auto z = [](double found, double n, double fraction) {
        return std::fabs(found - n * fraction) / std::sqrt(n * fraction * (1.0 - fraction));
    };
    CHECK(z(on_ball, 40000.0, ball / area) < 4.5);
    CHECK(z(wall, 40000.0, 16.0 / area) < 4.5);
    CHECK(z(first, 10000.0, ball / area) < 4.5);
    CHECK(z(wall, 40000.0, 0.9 * 16.0 / area) > 4.5);
}

TEST_CASE("Holes are filled from what lies around them, and what is known stays", "[imperfect_shadow_maps]") {
    std::vector<float> map(64, 2.0f);
    for (const int hole : {0, 9, 27, 28, 35, 36, 63}) map[std::size_t(hole)] = 0.0f;
    pull_push(map, 8);
    CHECK(std::ranges::all_of(map, [](float d) { return d == 2.0f; }));
    // One texel in a corner of the sky stays one.
    std::vector<float> sky(64, 0.0f);
    sky[10] = 3.0f;
    pull_push(sky, 8);
    CHECK(std::ranges::count(sky, 3.0f) == 1);
    CHECK(std::ranges::count(sky, 0.0f) == 63);
    std::vector<float> odd(25, 0.0f);
    for (int i = 0; i < 15; ++i) odd[std::size_t(i)] = float(i + 1);
    auto filled = odd;
    pull_push(filled, 5);
    CHECK(std::equal(odd.begin(), odd.begin() + 15, filled.begin()));
}

TEST_CASE("A wall of points is found where it is, at any slant", "[imperfect_shadow_maps]") {
    // Points of one plane, densely: what lies behind it by two texels is dark, and what lies before it is
    // lit.
    Rng rng(3);
    const Vec3 n = glm::normalize(Vec3(0.6f, 0.5f, -1.0f));
    SurfaceSamples wall;
    const Frame frame(n);
    for (int i = 0; i < 40000; ++i) {
        const Vec2 at = 8.0f * rng.next_vec2() - 4.0f;
        wall.points.push_back({-1.0f * n + at.x * frame.s + at.y * frame.t, n});
    }
    wall.density = 40000.0f / 64.0f;
    for (const Vec3& normal : {Vec3(0.0f), -n, glm::normalize(Vec3(0.3f, -0.5f, 0.8f))}) {
        VplSet vpls;
        VirtualPointLight vpl;
        vpl.position = Vec3(0.1f, -0.1f, 0.2f), vpl.normal = normal;
        vpls.lights.push_back(vpl);
        ImperfectShadowMaps maps;
        maps.build(wall, vpls, {.size = 64, .points = 40000}, 1);
        int wrong_behind = 0, wrong_before = 0, count = 0;
        for (int k = 0; k < 2000; ++k) {
            const Vec2 at = 3.0f * rng.next_vec2() - 1.5f;
            const Vec3 d = -1.0f * n + at.x * frame.s + at.y * frame.t - vpl.position;
            if (vpl.on_surface() && glm::dot(d, normal) < 0.1f * glm::length(d)) continue;
            wrong_behind += maps.visible(0, vpl.position + 1.4f * d);
            wrong_before += !maps.visible(0, vpl.position + d), ++count;
        }
        INFO(normal.x << " of " << count);
        CHECK(count > 300);
        CHECK(wrong_behind <= count / 100);
        CHECK(wrong_before <= count / 200);
    }
}

TEST_CASE("Little light leaks through a closed wall of points", "[imperfect_shadow_maps]") {
    // 475 points of a map's 8192 are the box's.
    CHECK(leak({}) <= 0.015);
    CHECK(leak({.points = 32768}) <= 0.002);
    // Discs that cover less, and open gaps, let more through.
    CHECK(leak({.splat = 1.0f}) > 0.1);
    CHECK(leak({.pull_push = false}) > 0.03);
}

TEST_CASE("Answers of imperfect maps are those of rays but for a stated fraction",
          "[imperfect_shadow_maps]") {
    const auto scene = furnished();
    const Wrong usual = wrong_answers(*scene, {});
    INFO("near " << usual.near << ", far " << usual.far << ", lit " << usual.lit);
    CHECK(usual.near <= 0.04);
    CHECK(usual.far <= 0.08);
    CHECK((usual.lit > 0.2 && usual.lit < 0.8));  // errors of both kinds
    CHECK(wrong_answers(*scene, {.size = 64}).far < 0.75 * usual.far);
    CHECK(wrong_answers(*scene, {.size = 12}).far > 1.25 * usual.far);
    CHECK(wrong_answers(*scene, {.splat = 0.25f}).near > 1.5 * usual.near);
}

TEST_CASE("Maps without points, lights or texels to spare are right, and the same on any threads",
          "[imperfect_shadow_maps]") {
    const auto scene = furnished();
    const VplSet vpls = trace_light_paths(*scene, {.paths = 20}, 3, 0, SamplerKind::sobol);
    ImperfectShadowMaps maps;
    maps.build({}, vpls, {}, 1);
    CHECK(maps.visible(0, Vec3(1.0f)));
    maps.build(sample_surfaces(*scene, 100, 1), {}, {}, 1);
    CHECK(maps.count() == 0);
    CHECK(sample_surfaces(*scene, 0, 1).points.empty());
    const SurfaceSamples points = sample_surfaces(*scene, 3000, 1);
    const ImperfectMapSettings small{.size = 1, .points = 3000};
    maps.build(points, vpls, small, 1);
    CHECK(maps.count() == vpls.lights.size());
    CHECK(maps.visible(0, vpls.lights[0].position));  // a receiver on the light
    std::vector<bool> answers;
    for (const int threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
        const SurfaceSamples again = sample_surfaces(*scene, 3000, 1);
        maps.build(again, vpls, {.points = 1000}, 1);
        std::vector<bool> now;
        for (const SurfaceHit& hit : receivers(*scene, 100))
            for (std::size_t j = 0; j < maps.count(); ++j) now.push_back(maps.visible(j, hit.position));
        CHECK((answers.empty() || answers == now));
        answers = now;
    }
}
