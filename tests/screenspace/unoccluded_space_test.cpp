// A triangle said to be clear must not hold a single shadow ray that hits.
#include "screenspace/in_scattering/unoccluded_space.h"

#include <fmt/format.h>

#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

struct Numbers {
    Rng rng;
    float in(float a, float b) { return a + (b - a) * rng.next_float(); }
    Vec3 point(float size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
    Vec3 direction() {
        for (;;)
            if (const Vec3 v = point(1.0f); glm::dot(v, v) > 0.01f) return glm::normalize(v);
    }
};

/// Spheres, discs, cylinders, cubes and rectangles of all sizes, here and there.
std::unique_ptr<Scene> random_scene(Numbers& random, int shapes, float size, const std::string& bsdf) {
    std::string xml;
    for (int i = 0; i < shapes; ++i) {
        const char* kinds[] = {"sphere", "disk", "cylinder", "cube", "rectangle"};
        const Vec3 at = random.point(size);
        const float scale = size * std::pow(10.0f, random.in(-2.5f, -0.5f));
        xml += fmt::format(
            R"(<shape type="{}"><transform name="to_world"><rotate x="1" angle="{}"/><rotate y="1" angle="{}"/>
            <scale value="{}"/><translate x="{}" y="{}" z="{}"/></transform><bsdf type="{}"/></shape>)",
            kinds[i % 5], i % 7 == 0 ? 0.0f : random.in(0.0f, 360.0f), random.in(0.0f, 360.0f), scale, at.x,
            at.y, at.z, bsdf);
    }
    return tests::scene_from(fmt::format(R"(<scene version="3.0.0">{}<emitter type="point"/>
        <sensor type="perspective"/></scene>)",
                                         xml));
}

bool any_hit(const Scene& scene, const Ray& ray, float from, float to, const Vec3& light, Numbers& random) {
    for (int k = 0; k < 150; ++k) {
        const float u = k == 0 ? 0.0f : k == 1 ? 1.0f : random.rng.next_float();
        const Vec3 x = ray.at(from + u * (to - from)), d = light - x;
        const float distance = glm::length(d);
        if (scene.rays().occluded({x, d / distance, 0.0f, distance})) return true;
    }
    return false;
}

struct Outcome {
    int clear = 0, wrong = 0, unhit = 0;
};

/// Triangles between a light and a piece of a ray, `shrink` of which is tested.
Outcome try_triangles(float size, double shrink, bool infinite) {
    Numbers random{Rng(7)};
    Outcome o;
    for (int s = 0; s < 12; ++s) {
        const auto scene = random_scene(random, 10 + 4 * s, size, "diffuse");
        const UnoccludedSpace space(scene->shapes());
        CHECK(space.memory_bytes() > 0);
        for (int i = 0; i < 250; ++i) {
            Ray ray{random.point(size), random.direction()};
            const Vec3 light = i % 5 == 0 ? ray.at(size * random.in(-1, 1)) : random.point(size);  // or on it
            const auto hit = scene->rays().closest(ray);
            const float end = infinite ? 50.0f * size : hit ? hit->t : size * random.in(0.001f, 3.0f);
            if (infinite && hit) continue;
            const float from = i % 3 == 0 ? 0.0f : end * random.in(0.0f, 0.9f),
                        to = end - 1e-3f * (end - from);
            const Vec3d a(ray.at(from)), b(ray.at(to)), l(light);
            const bool clear = infinite ? space.free_of_surfaces(l, a, Vec3d(ray.direction))
                                        : space.free_of_surfaces({l, a, a + shrink * (b - a)});
            const bool hits = any_hit(*scene, ray, from, to, light, random);
            o.clear += clear, o.unhit += !hits, o.wrong += clear && hits;
        }
    }
    return o;
}

}  // namespace

TEST_CASE("Clear triangles are clear", "[unoccluded_space]") {
    for (const float size : {1.0f, 1e-4f, 1e4f}) {
        const Outcome o = try_triangles(size, 1.0, false);
        CHECK(o.wrong == 0);
        CHECK(o.clear > o.unhit / 2);  // and it is found
        CHECK(o.clear > 500);
    }
    const Outcome to_infinity = try_triangles(1.0f, 1.0, true);
    CHECK(to_infinity.wrong == 0);
    CHECK(to_infinity.clear > 20);
}

TEST_CASE("Triangles that are too small are found out", "[unoccluded_space]") {
    CHECK(try_triangles(1.0f, 0.5, false).wrong > 0);
}

TEST_CASE("Boundaries of media are apart from surfaces", "[unoccluded_space]") {
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">
        <shape type="cube"><bsdf type="null"/><medium type="homogeneous" name="interior"/></shape>
        <shape type="rectangle"><transform name="to_world"><translate z="3"/></transform><bsdf type="diffuse"/></shape>
        <emitter type="point"/><sensor type="perspective"/></scene>)");
    const UnoccludedSpace space(scene->shapes());
    const UnoccludedSpace::Triangle inside = {Vec3d(0, 0, 0), Vec3d(0.5, 0, 0), Vec3d(0, 0.9, 0.2)};
    const UnoccludedSpace::Triangle across = {Vec3d(0, 0, 0), Vec3d(0.5, 0, 0), Vec3d(0, 1.1, 0.2)};
    const UnoccludedSpace::Triangle beyond = {Vec3d(0, 0, 2), Vec3d(0.5, 0, 2), Vec3d(0, 0.5, 3.1)};
    CHECK(space.free_of_boundaries(inside));
    CHECK(space.free_of_surfaces(inside));
    CHECK_FALSE(space.free_of_boundaries(across));
    CHECK(space.free_of_surfaces(across));
    CHECK(space.free_of_boundaries(beyond));
    CHECK_FALSE(space.free_of_surfaces(beyond));
    const Vec3d nan(std::nan(""));
    CHECK_FALSE(space.free_of_surfaces({nan, nan, nan}));
}
