// The spot light: fall-off, texture projection, orientation, very narrow and very wide cones.
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::lights;

namespace {

constexpr double degree = 3.14159265358979323846 / 180.0;

/// Intensity that a receiver at distance 2 and `angle` from the axis (+z), turned by phi about it, sees.
Rgb intensity(const Emitter& light, double angle, double phi = 0.0) {
    const Vec3 p(2.0 *
                 Vec3d(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle)));
    const auto s = light.sample_direct(p, Vec2(0.5f));
    return s ? s->weight * 4.0f : Rgb(0.0f);
}

}  // namespace

TEST_CASE("a spot falls off linearly in the angle", "[lights][emitters][spot]") {
    const auto light = make_spot_light({.intensity = Rgb(8.0f)});  // 20 and 15 degrees
    CHECK(intensity(*light, 0.0).x == Approx(8.0));
    CHECK(intensity(*light, 14.99 * degree).x == Approx(8.0));
    CHECK(intensity(*light, 16.0 * degree, 1.0).x == Approx(6.4).epsilon(1e-4));
    CHECK(intensity(*light, 17.5 * degree, 2.0).x == Approx(4.0).epsilon(1e-4));
    CHECK(intensity(*light, 19.0 * degree, 3.0).x == Approx(1.6).epsilon(1e-4));
    CHECK(intensity(*light, 20.01 * degree) == Rgb(0.0f));
    CHECK(intensity(*light, 180.0 * degree) == Rgb(0.0f));
}

TEST_CASE("a spot's power is the integral of its intensity", "[lights][emitters][spot]") {
    // Cutoff and beam, both from hair-thin to the whole sphere.
    for (const auto& [cutoff, beam] : {std::pair{20.0, 15.0},
                                       {0.01, 0.0075},
                                       {30.0, 0.0},
                                       {30.0, 30.0},
                                       {90.0, 45.0},
                                       {180.0, 180.0},
                                       {180.0, 0.0}}) {
        INFO(cutoff << " and " << beam);
        const auto light = make_spot_light({.cutoff_angle = cutoff * degree, .beam_width = beam * degree});
        double quadrature = 0.0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const double angle = (i + 0.5) / n * cutoff;
            const double f = angle <= beam ? 1.0 : (cutoff - angle) / (cutoff - beam);
            quadrature += 2.0 * double(pi) * f * std::sin(angle * degree) * cutoff * degree / n;
        }
        CHECK(light->power().x == Approx(quadrature).epsilon(1e-5));
        CHECK(agree(particle_power(*light, 100000), Rgb(float(quadrature))));
    }
}

TEST_CASE("a spot projects its texture through the cone", "[lights][emitters][spot]") {
    const auto light = make_spot_light(
        {.cutoff_angle = 20 * degree, .beam_width = 20 * degree, .texture = gradient_texture()});
    // uv = 1/2 + 1/2 (x, y) / (z tan(cutoff)): the centre of the texture is the axis, +x is +u, +y is +v.
    const auto at = [&](double x, double y) {
        const double angle = std::atan(std::hypot(x, y) * std::tan(20 * degree));
        return intensity(*light, angle, std::atan2(y, x));
    };
    CHECK(at(0.5, 0.0).x == Approx(0.75).epsilon(1e-4));
    CHECK(at(0.5, 0.0).y == Approx(0.5).epsilon(1e-4));
    CHECK(at(0.5, 0.0).z == 0.0f);
    CHECK(at(-0.9, 0.0).x == Approx(0.05).epsilon(1e-3));
    CHECK(at(-0.9, 0.0).z == Approx(1.0));
    CHECK(at(-0.3, 0.6).y == Approx(0.8).epsilon(1e-4));
    CHECK(light->traits().textured);
}

TEST_CASE("a texture finer than the power estimate still leaves power", "[lights][emitters][spot]") {
    const auto needle = std::make_shared<FunctionTexture>(
        [](const Vec2& uv) { return Rgb(uv.x > 0.5f && uv.x < 0.5001f ? 1.0f : 0.0f); }, Rgb(1e-4f), 0.0f,
        1.0f);
    CHECK(make_spot_light({.texture = needle})->power().x > 0.0f);
}

TEST_CASE("a spot follows its to_world", "[lights][emitters][spot]") {
    // Turned by 180 degrees about x: +z to -z, +y to -y; an even scale and a mirror change no angle.
    const auto scale = Transform(glm::scale(glm::dmat4(1.0), Vec3d(-3, 3, 3)));
    const auto light = make_spot_light({.to_world = facing_down({0, 0, 5}) * scale,
                                        .cutoff_angle = 20 * degree,
                                        .beam_width = 20 * degree,
                                        .texture = gradient_texture()});
    const auto s = light->sample_direct(Vec3(0.5f, 0.8f, 1.0f), Vec2(0.5f));
    REQUIRE(s);
    const Rgb value = s->weight * s->distance * s->distance;
    const double width = 4.0 * std::tan(20 * degree);
    CHECK(value.x == Approx(0.5 - 0.5 * 0.5 / width).epsilon(1e-4));
    CHECK(value.y == Approx(0.5 - 0.5 * 0.8 / width).epsilon(1e-4));
    const auto particle = light->sample_emission(Vec2(0.5f), Vec2(0.0f));
    REQUIRE(particle);
    CHECK(particle->direction.z == Approx(-1.0));
}
