// Direct sampling against closed forms, and its density against pdf_direct().
#include "core/geometry/ray_tracer.h"
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::lights;

namespace {

const Vec3 up(0, 0, 1);

/// Irradiance / (pi L) at the origin, facing +z, from the rectangle [-a, a] x [-b, b] at height h facing
/// down: four times the form factor of one quarter seen from below its corner (Howell 2010, B-3).
double rectangle_form_factor(double a, double b, double h) {
    const double x = a / h, y = b / h, sx = std::sqrt(1 + x * x), sy = std::sqrt(1 + y * y);
    return 4.0 / (2.0 * double(pi)) * (x / sx * std::atan(y / sx) + y / sy * std::atan(x / sy));
}

bool irradiance_is(const Emitter& light, const Rgb& expected, int samples = 100000) {
    const MeanRgb mean = irradiance(light, Vec3(0), up, samples);
    INFO(mean.channel[0].value() << " +- " << mean.channel[0].error() << " against " << expected.x);
    return agree(mean, expected);
}

}  // namespace

TEST_CASE("irradiance from every light with a closed form", "[lights][emitters]") {
    const Rgb value(3, 2, 1);
    SECTION("point: I cos / d^2") {
        CHECK(irradiance_is(*make_point_light({0, 3, 4}, value), value * (0.8f / 25.0f), 10));
    }
    SECTION("directional: E cos") {
        CHECK(irradiance_is(*make_directional_light({0, -3, -4}, value), value * 0.8f, 10));
    }
    SECTION("constant: pi L") { CHECK(irradiance_is(*make_constant_light(value), pi * value)); }
    SECTION("rectangle") {
        const auto scaled =
            facing_down({0, 0, 1.5}) * Transform(glm::scale(glm::dmat4(1.0), Vec3d(2, 0.5, 1)));
        const auto light = on_shape("", mesh_shape(make_rectangle(), scaled), make_area_light(value));
        CHECK(irradiance_is(*light.light, value * pi * float(rectangle_form_factor(2.0, 0.5, 1.5))));
    }
    SECTION("disk: pi L R^2 / (R^2 + h^2)") {
        const auto light = on_shape("", make_disk(facing_down({0, 0, 2}), false), make_area_light(value));
        CHECK(irradiance_is(*light.light, value * pi * 0.2f));
    }
    SECTION("sphere: pi L R^2 / d^2, near and far") {
        for (const double distance : {1.01, 2.0, 1000.0}) {
            const auto light =
                on_shape("", make_sphere({0, 0, distance}, 1.0, {}, false), make_area_light(value));
            CHECK(irradiance_is(*light.light, value * pi * float(1.0 / (distance * distance))));
        }
    }
    SECTION("inside an inverted sphere: pi L") {
        const auto light = on_shape("", make_sphere({0.1, 0.2, 0.3}, 2.0, {}, true), make_area_light(value));
        CHECK(irradiance_is(*light.light, value * pi, 400000));
    }
    SECTION("environment of one colour: pi L") {
        for (const auto& [w, h] : {std::pair{1, 1}, {1, 5}, {7, 1}, {8, 4}}) {
            const auto light =
                make_environment_map(Bitmap{w, h, std::vector<Rgb>(std::size_t(w * h), value)});
            INFO(w << " x " << h);
            CHECK(irradiance_is(*light, pi * value));
        }
    }
}

TEST_CASE("a planted two percent is caught", "[lights][emitters]") {
    CHECK_FALSE(irradiance_is(*make_constant_light(Rgb(1.02f)), Rgb(pi)));
    const auto light = on_shape("", make_disk(facing_down({0, 0, 2}), false), make_area_light(Rgb(0.98f)));
    CHECK_FALSE(irradiance_is(*light.light, Rgb(pi * 0.2f)));
}

TEST_CASE("area lights are one-sided", "[lights][emitters]") {
    const auto light = on_shape("", make_disk(facing_down({0, 0, 2}), false));
    Rng rng(5);
    for (int i = 0; i < 100; ++i) {
        CHECK(light.light->sample_direct(Vec3(0, 0, 1), rng.next_vec2()));
        CHECK_FALSE(light.light->sample_direct(Vec3(0, 0, 3), rng.next_vec2()));
    }
    SurfaceHit hit;
    hit.geometric_normal = Vec3(0, 0, -1);
    // A shading normal on the wrong side changes nothing.
    hit.shading = Frame(Vec3(0, 0, 1));
    CHECK(light.light->radiance(hit, Vec3(0, 0, -1)) == Rgb(3, 2, 1));
    CHECK(light.light->radiance(hit, Vec3(0, 0, 1)) == Rgb(0.0f));
    CHECK(light.light->pdf_direct(Vec3(0, 0, 3), Vec3(0, 0, -1), &hit) == 0.0f);
}

TEST_CASE("the density of a sample is what pdf_direct says", "[lights][emitters]") {
    const Vec3 receivers[] = {Vec3(0.0f), Vec3(0.4f, -0.3f, 0.1f), Vec3(-0.6f, 0.5f, 0.3f)};
    for (const auto& example : light_examples()) {
        INFO(example.name);
        const auto traits = example.light->traits();
        std::vector<std::shared_ptr<Shape>> shapes;
        if (example.shape) shapes.push_back(example.shape);
        const RayTracer rays(shapes);
        int compared = 0, apart = 0;
        for (const Vec3& p : receivers) {
            Rng rng(7);
            for (int i = 0; i < 2000; ++i) {
                const auto s = example.light->sample_direct(p, rng.next_vec2());
                if (!s) continue;
                REQUIRE(std::fabs(glm::length(s->wi) - 1.0f) < 1e-5f);
                REQUIRE(s->delta == !traits.can_be_hit());
                REQUIRE((s->distance == infinity) == traits.infinite);
                if (s->delta) {
                    REQUIRE(s->pdf_solid_angle == 0.0f);
                    REQUIRE(example.light->pdf_direct(p, s->wi, nullptr) == 0.0f);
                    continue;
                }
                Rgb radiance(0.0f);
                float pdf = 0.0f;
                if (traits.infinite) {
                    radiance = example.light->environment(s->wi);
                    pdf = example.light->pdf_direct(p, s->wi, nullptr);
                } else {
                    const auto hit = rays.closest(Ray{p, s->wi, 0.0f, s->distance * 1.001f});
                    // Samples on the silhouette miss by rounding; on a convex light the hit is the sample.
                    if (!hit || std::fabs(hit->t - s->distance) > 1e-3f * s->distance) {
                        ++apart;
                        continue;
                    }
                    REQUIRE(glm::dot(s->normal, s->wi) < 0.0f);
                    radiance = example.light->radiance(*hit, -s->wi);
                    pdf = example.light->pdf_direct(p, s->wi, &*hit);
                }
                ++compared;
                const bool same = std::fabs(pdf - s->pdf_solid_angle) <= 5e-3f * s->pdf_solid_angle &&
                                  glm::length(s->weight * s->pdf_solid_angle - radiance) <=
                                      5e-3f * glm::length(radiance) + 1e-4f;
                if (!same) ++apart;
            }
        }
        if (traits.can_be_hit()) CHECK(compared > 1000);
        // Rounding at the borders of cells, edges and silhouettes; cubes hide their own samples behind faces,
        // which the normal test above has sorted out.
        CHECK(apart <= compared / 200);
    }
}

TEST_CASE("nothing is infinite on top of a light", "[lights][emitters]") {
    const auto point = make_point_light({1, 2, 3}, Rgb(1e12f));
    CHECK_FALSE(point->sample_direct(Vec3(1, 2, 3), Vec2(0.5f)));
    const auto near = point->sample_direct(Vec3(1, 2, 3.000001f), Vec2(0.5f));
    CHECK((!near || is_finite(near->weight)));
    const auto area = on_shape("", mesh_shape(make_rectangle(), {}));
    Rng rng(3);
    int found = 0;
    for (int i = 0; i < 10000; ++i) {
        const auto s = area.light->sample_direct(Vec3(0.1f, 0.2f, i % 2 ? 0.0f : 1e-7f), rng.next_vec2());
        if (!s) continue;
        ++found;
        REQUIRE((is_finite(s->weight) && is_finite(s->wi) && std::isfinite(s->pdf_solid_angle)));
    }
    CHECK(found > 0);
}
