// Ray marching of one light against integrals by another method, and the cone of a spot light.
#include "screenspace/in_scattering/in_scattering.h"

#include <fmt/format.h>

#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;

namespace {

/// Fog in a box of 4 m, a light of intensity 3 at (0.5, 0.3, 0), optionally a wall that shadows x < 0.
std::unique_ptr<Scene> fog_box(const std::string& light, bool wall = false) {
    const std::string shade = R"(<shape type="rectangle"><transform name="to_world"><scale value="5"/>
        <rotate y="1" angle="90"/></transform><bsdf type="diffuse"/></shape>)";
    return tests::scene_from(fmt::format(R"(<scene version="3.0.0">
        <shape type="cube"><transform name="to_world"><scale value="2"/></transform><bsdf type="null"/>
          <medium type="homogeneous" name="interior"><rgb name="sigma_t" value="0.2, 0.4, 0.8"/>
          <rgb name="albedo" value="0.9, 0.6, 0.3"/><phase type="hg"><float name="g" value="0.4"/></phase></medium></shape>
        {}{}<sensor type="perspective"/></scene>)",
                                         light, wall ? shade : ""));
}
const std::string point = R"(<emitter type="point"><point name="position" x="0.5" y="0.3" z="0"/>
    <rgb name="intensity" value="3"/></emitter>)";

/// Integral by a midpoint rule of a million steps, from the formula.
Vec3d integral(const Ray& ray, double t0, double t1, bool shadowed) {
    const Vec3d sigma_t(0.2, 0.4, 0.8), sigma_s = sigma_t * Vec3d(0.9, 0.6, 0.3), light(0.5, 0.3, 0.0);
    const double g = 0.4;
    Vec3d sum(0.0);
    constexpr int n = 1000000;
    for (int i = 0; i < n; ++i) {
        const double t = t0 + (i + 0.5) / n * (t1 - t0);
        const Vec3d x = Vec3d(ray.origin) + t * Vec3d(ray.direction), to_light = light - x;
        if (shadowed && x.x < 0.0) continue;
        const double d = glm::length(to_light), cosine = glm::dot(to_light / d, -Vec3d(ray.direction));
        const double phase =
            (1.0 - g * g) / (4.0 * double(pi) * std::pow(1.0 + g * g + 2.0 * g * cosine, 1.5));
        sum += sigma_s * glm::exp(-sigma_t * (t - t0 + d)) * (3.0 * phase / (d * d));
    }
    return sum * ((t1 - t0) / n);
}

Vec3d marched(const Scene& scene, const Ray& ray, MarchRule rule, int steps, int offsets) {
    Vec3d sum(0.0);
    MarchScratch scratch;
    for (int i = 0; i < offsets; ++i) {
        const InScattering light(scene, *scene.emitters()[0],
                                 {steps, rule, (float(i) + 0.5f) / float(offsets), 1.0f});
        sum += Vec3d(light.march(ray, MediumState(), scratch).radiance);
    }
    CHECK(scratch.rays == std::uint64_t(offsets));
    return sum / double(offsets);
}

void check_close(const Vec3d& a, const Vec3d& b, double tolerance) {
    for (int c = 0; c < 3; ++c) CHECK(a[c] == Approx(b[c]).epsilon(tolerance));
}

}  // namespace

TEST_CASE("Marched light is the integral, by either rule", "[in_scattering]") {
    const auto scene = fog_box(point);
    const Ray ray{Vec3(-1.0f, 0.1f, 5.0f), glm::normalize(Vec3(0.2f, 0.02f, -1.0f)), 0.0f, 100.0f};
    const double slope = double(ray.direction.z);
    const Vec3d expected = integral(ray, (2.0 - 5.0) / slope, (-2.0 - 5.0) / slope, false);
    check_close(marched(*scene, ray, MarchRule::equiangular, 64, 1), expected, 1e-3);
    check_close(marched(*scene, ray, MarchRule::uniform, 512, 1), expected, 1e-3);
    // Few steps, many offsets: the mean over offsets is the integral too.
    check_close(marched(*scene, ray, MarchRule::equiangular, 3, 200), expected, 1e-3);
    check_close(marched(*scene, ray, MarchRule::uniform, 3, 500), expected, 1e-3);
    CHECK(std::abs(marched(*scene, ray, MarchRule::uniform, 3, 1).x / expected.x - 1.0) > 1e-2);
}

TEST_CASE("Marched light has shadows", "[in_scattering]") {
    const auto scene = fog_box(point, true);
    const Ray ray{Vec3(-1.0f, 0.1f, 1.9f), glm::normalize(Vec3(0.2f, 0.02f, -1.0f)), 0.0f, 3.0f};
    MediumState inside = scene->medium_state_at(ray.origin, nullptr);
    MarchScratch scratch;
    const InScattering light(*scene, *scene->emitters()[0], {1024, MarchRule::equiangular, 0.5f, 1.0f});
    const Vec3d expected = integral(ray, 0.0, 3.0, true), unshadowed = integral(ray, 0.0, 3.0, false);
    CHECK(expected.x < 0.9 * unshadowed.x);
    check_close(Vec3d(light.march(ray, inside, scratch).radiance), expected, 1e-2);
}

TEST_CASE("Rays are cut to a light's cone", "[in_scattering]") {
    Rng rng(5);
    const auto random_vector = [&] {
        return Vec3(rng.next_float() - 0.5f, rng.next_float() - 0.5f, rng.next_float() - 0.5f);
    };
    for (int i = 0; i < 300; ++i) {
        const lights::LightCone cone{random_vector(), glm::normalize(random_vector()),
                                     0.02 + 1.5 * double(rng.next_float())};
        const Ray ray{2.0f * random_vector(), glm::normalize(random_vector())};
        const auto part = lights::inside_cone(cone, ray, 0.0, i % 3 == 0 ? double(infinity) : 3.0);
        for (int k = 0; k < 200; ++k) {
            const double t = 3.0 * (k + 0.5) / 200.0;
            const Vec3d d = Vec3d(ray.origin) + t * Vec3d(ray.direction) - Vec3d(cone.apex);
            const double angle = std::acos(glm::dot(glm::normalize(d), Vec3d(cone.axis)));
            if (std::abs(angle - cone.angle) < 1e-4) continue;
            const bool inside = part && part->first <= t && t <= part->second;
            CHECK(inside == (angle < cone.angle));
        }
    }
    const Ray ray{Vec3(0, 0, 0), Vec3(0, 0, 1)};
    CHECK(lights::inside_cone({Vec3(0, 0, 0), Vec3(0, 0, 1), 2.0}, ray, 1.0, 2.0) == std::pair(1.0, 2.0));
    CHECK_FALSE(lights::inside_cone({Vec3(0, 0, 0), Vec3(0, 0, -1), 0.5}, ray, 1.0, 2.0));
}

TEST_CASE("A spot's cone holds all its light", "[in_scattering]") {
    const auto scene = fog_box(R"(<emitter type="spot"><transform name="to_world"><lookat origin="0.5, 0.3, 0"
        target="0, 0, 1" up="0, 1, 0"/></transform><float name="cutoff_angle" value="25"/></emitter>)");
    const InScattering light(*scene, *scene->emitters()[0], {});
    Rng rng(9);
    int lit = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 origin(4.0f * (rng.next_float() - 0.5f), 4.0f * (rng.next_float() - 0.5f), 3.0f);
        const Ray ray{origin, glm::normalize(Vec3(rng.next_float() - 0.5f, rng.next_float() - 0.5f, -1.0f)),
                      0.0f, 8.0f};
        const auto part = light.lit_part(ray);
        const float t = 8.0f * rng.next_float();
        const Vec3 x = ray.at(t);
        if (max_component(glm::abs(x)) > 2.0f || !scene->emitters()[0]->sample_direct(x, Vec2(0.5f)))
            continue;
        ++lit;
        REQUIRE(part);
        CHECK(t >= part->t0 - 1e-4f);
        CHECK(t <= part->t1 + 1e-4f);
    }
    CHECK(lit > 20);
}
