// The projector: Mitsuba's brightness, which way round the picture lies, and its power, from hair-thin to
// almost half of all directions.
#include "core/materials/textures.h"
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"

using namespace mote::tests;
using namespace mote::lights;

namespace {

/// Irradiance over pi at the point (x, y, 1), on a surface that faces -z: what a white wall there shows.
Rgb wall(const Emitter& light, double x, double y, double z = 1.0) {
    const auto s = light.sample_direct(Vec3(Vec3d(x, y, z)), Vec2(0.5f));
    return s ? s->weight * -s->wi.z * inv_pi : Rgb(0.0f);
}

/// Black but for texel (x, y) of n x n.
std::shared_ptr<Texture> one_texel(int n, int x, int y) {
    return std::make_shared<FunctionTexture>(
        [=](const Vec2& uv) {
            return Rgb(int(uv.x * float(n)) == x && int(uv.y * float(n)) == y ? 1.0f : 0.0f);
        },
        Rgb(1.0f / float(n * n)), 0.0f, 1.0f);
}

}  // namespace

TEST_CASE("a wall at distance 1 shows the projector's picture", "[lights][emitters][projector]") {
    ProjectorSettings s;
    s.irradiance = gradient_texture(), s.scale = 3.0f, s.tan_half_fov_x = 0.5;
    const auto light = make_projector_light(s);
    // uv = 1/2 - (x, y) / (2 * 0.5): the upper left corner, (0, 0), lies at +x, +y.
    for (const auto& [x, y] : {std::pair{0.0, 0.1}, {0.4, 0.4}, {-0.3, 0.2}, {0.25, -0.45}, {-0.49, -0.49}}) {
        INFO(x << " " << y);
        const Rgb shown = wall(*light, x, y);
        CHECK(shown.x == Approx(3.0 * (0.5 - x)).epsilon(1e-4));
        CHECK(shown.y == Approx(3.0 * (0.5 - y)).epsilon(1e-4));
        if (x != 0.0) CHECK(shown.z == Approx(x > 0.0 ? 3.0 : 0.0));
        CHECK(wall(*light, 2.0 * x, 2.0 * y, 2.0).x == Approx(0.25 * shown.x).epsilon(1e-4));
    }
    CHECK(wall(*light, 0.51, 0.0) == Rgb(0.0f));
    CHECK(wall(*light, 0.0, -0.51) == Rgb(0.0f));
    CHECK(wall(*light, 0.0, 0.0, -1.0) == Rgb(0.0f));
}

TEST_CASE("a projector's power is pi times the picture's area and mean", "[lights][emitters][projector]") {
    for (const double t : {1e-5, 0.01, 0.3, 1.0, 10.0, 100.0}) {
        INFO(t);
        ProjectorSettings s;
        s.tan_half_fov_x = t, s.irradiance = gradient_texture();
        const auto light = make_projector_light(s);
        const double expected = double(pi) * 4.0 * t * t * 0.5;
        CHECK(light->power().x == Approx(expected).epsilon(1e-4));
        CHECK(agree(particle_power(*light, 100000), Rgb(float(expected))));
    }
}

TEST_CASE("a single texel of a picture is sampled nearly always", "[lights][emitters][projector]") {
    ProjectorSettings s;
    s.tan_half_fov_x = 0.3, s.irradiance = one_texel(64, 17, 40);
    const auto light = make_projector_light(s);
    int lit = 0;
    Rng rng(3);
    for (int i = 0; i < 10000; ++i) {
        const Vec2 u = rng.next_vec2();
        lit += light->sample_emission(u, rng.next_vec2()) ? 1 : 0;
    }
    // Nine tenths by the table, which holds this texel alone, the rest evenly: a binomial count.
    const double p = 0.9 + 0.1 / 4096.0;
    CHECK(std::fabs(lit - 10000.0 * p) <= sigmas * std::sqrt(10000.0 * p * (1.0 - p)));
}

TEST_CASE("a projector's density is the integral of the filtered picture", "[lights][emitters][projector]") {
    // Bilinear filtering makes a tent of texel (3, 5): 3/4 of its integral along x, and along y, lie in the
    // texel's own cell, 1/8 in either cell beside it.
    Bitmap picture{8, 8, std::vector<Rgb>(64, Rgb(0.0f))};
    picture.pixels[5 * 8 + 3] = Rgb(2.0f);
    ProjectorSettings s;
    s.tan_half_fov_x = 0.3, s.irradiance = make_bitmap_texture(picture);
    const auto light = make_projector_light(s);
    const double probability[8] = {0, 0, 0.125, 0.75, 0.125, 0, 0, 0};
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            INFO(x << " " << y);
            const Vec3d through(0.3 * (1.0 - (x + 0.4) / 4.0), 0.3 * (1.0 - (y + 0.6) / 4.0), 1.0);
            const double cosine = 1.0 / glm::length(through);
            const double in_cell = probability[x] * (y >= 2 ? probability[y - 2] : 0.0);
            const double expected = (0.1 + 0.9 * 64.0 * in_cell) / (0.36 * cosine * cosine * cosine);
            CHECK(light->pdf_emission({}, {}, Vec3(glm::normalize(through))).pdf_solid_angle ==
                  Approx(expected).epsilon(1e-5));
        }
}

TEST_CASE("particles of a projector bring its irradiance", "[lights][emitters][projector]") {
    // A wall at distance 1 has irradiance pi scale E(u, v), and that of a linear picture has its mean over a
    // disk in the disk's middle.
    const auto check = [](const std::shared_ptr<Texture>& picture, const Patch& patch, const Rgb& shown) {
        ProjectorSettings s;
        s.tan_half_fov_x = 0.3, s.scale = 3.0f, s.irradiance = picture;
        const auto light = make_projector_light(s);
        const Rgb flux = pi * 3.0f * patch.area() * shown;
        const MeanRgb particles = flux_by_particles(*light, patch, 400000);
        CHECK(agree(particles, flux));
        for (const float planted : {0.95f, 1.05f}) CHECK_FALSE(agree(particles, planted * flux));
        CHECK(agree(flux_by_direct_sampling(*light, patch, 20000), flux));
    };
    // (u, v) = (1/2 - x / 0.6, 1/2 - y / 0.6)
    check(gradient_texture(), {{0.15f, -0.12f, 1.0f}, {0, 0, -1}, 0.1f}, Rgb(0.25f, 0.7f, 1.0f));
    check(one_texel(4, 1, 2), {{0.075f, -0.075f, 1.0f}, {0, 0, -1}, 0.07f}, Rgb(1.0f));
}

TEST_CASE("projectors refuse what has no picture", "[lights][emitters][projector]") {
    ProjectorSettings s;
    s.tan_half_fov_x = 0.0;
    CHECK_THROWS_AS(make_projector_light(s), InputError);
    s.tan_half_fov_x = 0.5, s.scale = -1.0f;
    CHECK_THROWS_AS(make_projector_light(s), InputError);
}
