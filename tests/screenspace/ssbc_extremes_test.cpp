// Extreme inputs of screen-space compensation: borders, sky, lamps, mirrors and glass, tiny and black images,
// light that is not finite, scales, and energy.
#include "core/scene/scene.h"
#include "screenspace/g_buffer/g_buffer.h"
#include "screenspace/ssbc/ssbc.h"
#include "tests/screenspace/ssbc_room.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::screenspace;
using namespace mote::tests;

namespace {

SsbcSettings with_bound(float bound, int steps = 2) {
    SsbcSettings s;
    s.bound = bound, s.steps = steps;
    return s;
}

double largest(const std::vector<Rgb>& pixels) {
    float result = 0.0f;
    for (const Rgb& p : pixels) result = std::max(result, max_component(p));
    return double(result);
}

/// Two small patches that face each other at distance d, in a picture of two pixels.
SsbcSurfaces pair_of_patches(float d, float area, const Vec3& to_viewer = {0, 0, 1}) {
    SsbcSurfaces s(2, 1);
    s.set(0, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, area, Rgb(0.5f));
    s.set(1, {0, 0, d}, {0, 0, -1}, to_viewer, area, Rgb(0.25f));
    return s;
}

}  // namespace

TEST_CASE("Two patches exchange G_r A L", "[ssbc]") {
    const float d = 0.5f, area = 1e-4f, bound = 1.0f;
    SsbcSurfaces s = pair_of_patches(d, area);
    s.normal[1] = {0, 0, -1};
    const std::vector<Rgb> light = {Rgb(3.0f), Rgb(1.0f, 2.0f, 4.0f)};
    const auto c = compensate(s, light, with_bound(bound, 1)).compensation;
    const float g = (1.0f / (d * d) - bound) * area * inv_pi;
    CHECK(c[0].x == Approx(0.5f * g * 1.0f).epsilon(1e-3));
    CHECK(c[0].z == Approx(0.5f * g * 4.0f).epsilon(1e-3));
    CHECK(c[1].y == Approx(0.25f * g * 3.0f).epsilon(1e-3));
    // Beyond the radius of the bound nothing is missing.
    CHECK(largest(compensate(s, light, with_bound(4.1f, 1)).compensation) == 0.0);
}

TEST_CASE("Pixels at a slant send less, down to nothing", "[ssbc]") {
    const auto sent = [](float degrees) {
        SsbcSurfaces s = pair_of_patches(0.5f, 1e-4f);
        s.facing[1] = std::cos(degrees * pi / 180.0f);
        const std::vector<Rgb> light = {Rgb(0.0f), Rgb(1.0f)};
        return compensate(s, light, with_bound(1.0f, 1)).compensation[0].x;
    };
    CHECK(sent(79.0f) == Approx(sent(0.0f)));
    CHECK(sent(85.0f) == Approx(0.25f * sent(0.0f)).epsilon(1e-3));
    CHECK(sent(90.0f) == Approx(0.0f).margin(1e-9));
}

TEST_CASE("No step adds more light than there was", "[ssbc][energy]") {
    // A box around the camera, white, in which everything is within the bound's radius; then the same with
    // areas ten times too large, as a broken G-buffer would have them.
    std::vector<Wall> walls;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3d c(0.0), u(0.0), v(0.0);
            c[axis] = side, u[(axis + 1) % 3] = 1.0, v[(axis + 2) % 3] = 1.0;
            walls.push_back({c, u, v, Rgb(1.0f)});
        }
    TestPicture picture = picture_of(walls, {{0, 0, 0.9}, {0, 0, 0}, {0.2, 1, 0}, 2.0, 48, 48});
    for (const float factor : {1.0f, 10.0f}) {
        for (float& a : picture.surfaces.area) a *= factor;
        double sum = 0.0;
        for (int steps = 1; steps <= 8; ++steps) {
            const SsbcResult r = compensate(picture.surfaces, picture.light, with_bound(1e-6f, steps));
            const double now = largest(r.compensation);
            CHECK(now <= double(steps) * 1.0001);
            CHECK(now >= sum);
            CHECK((r.counts.limited > 0) == (factor > 1.0f));
            sum = now;
        }
    }
}

TEST_CASE("Tiny, black and empty pictures", "[ssbc]") {
    SsbcSurfaces one(1, 1);
    const std::vector<Rgb> light = {Rgb(1.0f)};
    CHECK(largest(compensate(one, light, with_bound(1.0f)).compensation) == 0.0);
    one.set(0, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 1.0f, Rgb(0.5f));
    CHECK(largest(compensate(one, light, with_bound(1e-3f)).compensation) == 0.0);

    const TestPicture picture = room(33);
    const std::vector<Rgb> black(picture.light.size(), Rgb(0.0f));
    CHECK(largest(compensate(picture.surfaces, black, with_bound(10.0f)).compensation) == 0.0);
    for (const auto& [width, height] : {std::pair(1, 61), std::pair(61, 1), std::pair(2, 3)}) {
        Pinhole camera{{0.2, 0.3, 3.6}, {0, 0, 0}, {0, 1, 0}, std::tan(0.35), width, height};
        if (height == 1) camera.tangent /= 30.0;
        const TestPicture strip = picture_of(room_walls(), camera);
        for (const bool half : {false, true}) {
            SsbcSettings s = with_bound(1.0f);
            s.half_resolution = half, s.blur = 1.0f;
            for (const Rgb& c : compensate(strip.surfaces, strip.light, s).compensation) CHECK(is_finite(c));
        }
    }
}

TEST_CASE("Light that is not finite is counted and spreads no further", "[ssbc]") {
    TestPicture picture = room(40);
    const std::size_t hole = picture.index(20, 28);
    picture.light[hole] = Rgb(std::nanf(""));
    const SsbcResult r = compensate(picture.surfaces, picture.light, with_bound(10.0f));
    CHECK(r.non_finite == 1);
    for (const Rgb& c : r.compensation) CHECK(is_finite(c));
}

TEST_CASE("What cannot be computed is refused", "[ssbc]") {
    TestPicture picture = room(8);
    CHECK_THROWS_AS(compensate(picture.surfaces, picture.light, with_bound(-1.0f)), std::invalid_argument);
    CHECK_THROWS_AS(compensate(picture.surfaces, picture.light, with_bound(std::nanf(""))),
                    std::invalid_argument);
    CHECK_THROWS_AS(compensate(picture.surfaces, picture.light, with_bound(1.0f, 0)), std::invalid_argument);
    CHECK_THROWS_AS(SsbcSurfaces(0, 3), std::invalid_argument);
    SsbcSurfaces lost = picture.surfaces;  // written directly, past set()
    std::size_t patch = 0;
    while (lost.area[patch] == 0.0f) ++patch;
    lost.position[patch].y = std::nanf("");
    CHECK_THROWS_AS(lost.check(), std::invalid_argument);
    lost.position[patch] = picture.surfaces.position[patch], lost.normal[patch] *= 5.0f;
    CHECK_THROWS_AS(lost.check(), std::invalid_argument);
    lost.area[patch] = 0.0f;  // takes no part: what else it holds has no meaning
    CHECK_NOTHROW(lost.check());
    lost.area[patch] = -1.0f;
    CHECK_THROWS_AS(lost.check(), std::invalid_argument);
    auto light = picture.light;
    light.pop_back();
    CHECK_THROWS_AS(compensate(picture.surfaces, light, with_bound(1.0f)), std::invalid_argument);
    picture.surfaces.reflectance[3].y = 1.5f;
    CHECK_THROWS_AS(compensate(picture.surfaces, picture.light, with_bound(1.0f)), std::invalid_argument);
}

TEST_CASE("Lengths may have any unit", "[ssbc]") {
    const TestPicture picture = room(40);
    const auto metres = compensate(picture.surfaces, picture.light, with_bound(10.0f)).compensation;
    for (const float scale : {1e-4f, 1e4f}) {
        SsbcSurfaces s = picture.surfaces;
        for (std::size_t i = 0; i < s.pixel_count(); ++i) s.position[i] *= scale, s.area[i] *= scale * scale;
        const auto other = compensate(s, picture.light, with_bound(10.0f / (scale * scale))).compensation;
        double difference = 0.0;
        for (std::size_t i = 0; i < other.size(); ++i)
            difference = std::max(difference, double(glm::length(other[i] - metres[i])));
        CHECK(difference < 1e-3 * largest(metres));
    }
}

TEST_CASE("Sky, lamps, mirrors and glass take no part; plastic does with its base", "[ssbc]") {
    const auto scene = scene_from(R"(<scene version="3.0.0">
        <shape type="rectangle"><transform name="to_world"><translate x="-4"/></transform><bsdf type="conductor"/></shape>
        <shape type="rectangle"><transform name="to_world"><translate x="-2"/></transform><bsdf type="dielectric"/></shape>
        <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
        <shape type="rectangle"><transform name="to_world"><translate x="2"/></transform><bsdf type="roughplastic">
          <rgb name="diffuse_reflectance" value="0.5"/></bsdf></shape>
        <shape type="rectangle"><transform name="to_world"><translate x="4"/></transform><bsdf type="diffuse">
          <rgb name="reflectance" value="0.2, 0.4, 0.6"/></bsdf></shape>
        <sensor type="orthographic"><transform name="to_world"><scale x="6" y="6"/>
          <lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform></sensor></scene>)",
                                  12);
    const GBuffer g = make_g_buffer(*scene, scene->camera(), 12, 12);
    const SsbcSurfaces s = ssbc_surfaces(g);
    int seen[5] = {};
    for (std::size_t i = 0; i < s.pixel_count(); ++i) {
        if (!g.hit[i]) {
            CHECK(s.area[i] == 0.0f);
            continue;
        }
        const int which = int(std::lround((g.position[i].x + 4.0f) / 2.0f));
        ++seen[which];
        if (which < 3) CHECK(s.area[i] == 0.0f);
        if (which == 3) CHECK((s.reflectance[i].x > 0.2f && s.reflectance[i].x < 0.5f));
        if (which != 4) continue;
        CHECK(s.reflectance[i].y == Approx(0.4f));
        CHECK(s.area[i] == Approx(1.0f).epsilon(1e-3));  // parallel projection: 12 m by 12 pixels
    }
    for (const int n : seen) CHECK(n > 0);
}

TEST_CASE("Light comes from outside of the printed radius on the screen", "[ssbc]") {
    // Printed, docs/errata.md: what is within r of y lies within r / (tan(delta/2) |x - y|) on the screen. In
    // a row of 65 pixels, whose half holds a tangent of 1, a patch 18 pixels away is near enough, and 16 are
    // printed.
    const double r = 1.0, d = 2.0, pixel = 2.0 / 65.0;
    const int receiver = 32, sender = receiver + 18;
    const double printed = r / d / pixel;
    CHECK(printed < sender - receiver - 1);
    const Vec3d y(0.0, 0.0, d), along(18 * pixel, 0.0, 1.0);
    const Vec3d z = along * (glm::dot(along, y) / glm::dot(along, along));  // the point nearest to y
    const Vec3d n_y = glm::normalize(z - y), n_z = glm::normalize(Vec3d(-1.0, 0.0, 0.3));
    const double distance = glm::length(z - y), area = 1e-8, rho = 0.5, light = 3.0;
    CHECK(distance < r);
    SsbcSurfaces s(65, 1);
    s.set(receiver, Vec3(y), Vec3(n_y), Vec3(-y), float(area), Rgb(float(rho)));
    s.set(sender, Vec3(z), Vec3(n_z), Vec3(-z), float(area), Rgb(float(rho)));
    std::vector<Rgb> sent(65, Rgb(0.0f));
    sent[sender] = Rgb(float(light));
    const double g = glm::dot(n_z, -n_y) / (distance * distance);
    for (const bool hierarchical : {true, false}) {
        SsbcSettings settings = with_bound(float(1.0 / (r * r)), 1);
        settings.hierarchical = hierarchical;
        const auto c = compensate(s, sent, settings).compensation;
        CHECK(double(c[receiver].x) ==
              Approx(rho / double(pi) * (g - 1.0 / (r * r)) * area * light).epsilon(1e-3));
    }
}
