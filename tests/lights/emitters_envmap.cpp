// The environment map: orientation, lookup, sampling, and pictures that broke others.
#include "core/formats/pictures/image_file.h"
#include "lights/emitters/environment_picture.h"
#include "tests/lights/emitter_examples.h"
#include "tests/lights/emitter_statistics.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote::tests;
using namespace mote::lights;

namespace {

Bitmap black(int width, int height) {
    return {width, height, std::vector<Rgb>(std::size_t(width * height), Rgb(0.0f))};
}

/// The direction of texture coordinates: y up, u = atan2(x, -z) / 2 pi, v = acos(y) / pi.
Vec3 direction(double u, double v) {
    const double phi = 2.0 * double(pi) * u, theta = double(pi) * v;
    return Vec3(Vec3d(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)));
}

std::string message_of(const Bitmap& picture) {
    try {
        make_environment_map(picture);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("an environment map is oriented as documented", "[lights][emitters][envmap]") {
    // Eight columns, centres at u = (i + 1/2) / 8; five rows at v = 0, 1/4, 1/2, 3/4, 1.
    for (int column = 0; column < 8; ++column)
        for (int row = 0; row < 5; ++row) {
            INFO(column << ", " << row);
            Bitmap picture = black(8, 5);
            picture.pixels[std::size_t(row * 8 + column)] = Rgb(1, 2, 3);
            const EnvironmentPicture map(picture);
            if (row > 0 && row < 4)
                CHECK(glm::length(map.eval(direction((column + 0.5) / 8.0, row / 4.0)) - Rgb(1, 2, 3)) <
                      1e-4f);
            // Half-way to the neighbours, around the seam too.
            if (row == 2) {
                CHECK(map.eval(direction((column + 1.0) / 8.0, 0.5)).x == Approx(0.5).epsilon(1e-4));
                CHECK(map.eval(direction(column / 8.0, 0.5)).x == Approx(0.5).epsilon(1e-4));
                CHECK(map.eval(direction((column + 0.5) / 8.0, 0.375)).x == Approx(0.5).epsilon(1e-4));
                CHECK(map.eval(direction((column + 1.5) / 8.0, 0.5)).x < 1e-4f);
            }
        }
    // In words: up is the first row, -z is the seam (u = 0), +x a quarter to the right of it.
    Bitmap picture = black(8, 5);
    for (int x = 0; x < 8; ++x) picture.pixels[std::size_t(x)] = Rgb(1.0f);
    picture.pixels[16 + 1] = picture.pixels[16 + 2] = Rgb(2.0f);
    picture.pixels[16 + 0] = picture.pixels[16 + 7] = Rgb(3.0f);
    const EnvironmentPicture map(picture);
    CHECK(map.eval(Vec3(0, 1, 0)).x == Approx(1.0));
    CHECK(map.eval(Vec3(0, -1, 0)).x == 0.0f);
    CHECK(map.eval(Vec3(1, 0, 0)).x == Approx(2.0).epsilon(1e-4));
    CHECK(map.eval(Vec3(0, 0, -1)).x == Approx(3.0).epsilon(1e-4));
    CHECK(map.eval(Vec3(-1, 0, 0)).x < 1e-4f);
}

TEST_CASE("an environment map turns with to_world", "[lights][emitters][envmap]") {
    const EnvironmentPicture map(sky_picture());
    const auto turn = glm::rotate(glm::dmat4(1.0), 1.1, glm::normalize(Vec3d(3, -1, 2)));
    const auto light = make_environment_map(sky_picture(), Transform(turn), 2.0f);
    Rng rng(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 local = square_to_sphere(rng.next_vec2());
        const Vec3 world = Vec3(glm::dmat3(turn) * Vec3d(local));
        CHECK(glm::length(light->environment(world) - 2.0f * map.eval(local)) < 2e-3f);
    }
}

TEST_CASE("samples of an environment map follow its density", "[lights][emitters][envmap]") {
    constexpr int width = 16, height = 9, samples = 400000;
    const EnvironmentPicture map(sky_picture(width, height));
    // Every cell between pixels is cut into 2 x 2 bins, within which the density is constant.
    constexpr int bins_x = 2 * width, bins_y = 2 * (height - 1);
    std::vector<int> counts(bins_x * bins_y);
    Rng rng(17);
    for (int i = 0; i < samples; ++i) {
        const auto s = map.sample(rng.next_vec2());
        double u = std::atan2(s.direction.x, -s.direction.z) / (2.0 * double(pi)) - 0.5 / width;
        u -= std::floor(u);
        const double v = std::acos(std::clamp(double(s.direction.y), -1.0, 1.0)) / double(pi);
        ++counts[std::size_t(std::min(int(v * bins_y), bins_y - 1) * bins_x +
                             std::min(int(u * bins_x), bins_x - 1))];
    }
    double chi2 = 0.0, total = 0.0;
    for (int y = 0; y < bins_y; ++y)
        for (int x = 0; x < bins_x; ++x) {
            const Vec3 d = direction((x + 0.5) / bins_x + 0.5 / width, (y + 0.5) / bins_y);
            const double solid_angle =
                2.0 * double(pi) / bins_x *
                (std::cos(double(pi) * y / bins_y) - std::cos(double(pi) * (y + 1) / bins_y));
            const double probability = double(map.pdf_solid_angle(d)) * solid_angle;
            total += probability;
            REQUIRE(probability * samples > 5.0);
            chi2 += std::pow(counts[std::size_t(y * bins_x + x)] - probability * samples, 2) /
                    (probability * samples);
        }
    CHECK(total == Approx(1.0).epsilon(1e-5));
    // For many degrees of freedom k, chi^2 is close to normal with mean k and variance 2k.
    const double k = bins_x * bins_y - 1;
    CHECK(std::fabs(chi2 - k) < sigmas * std::sqrt(2.0 * k));
}

TEST_CASE("the integral of an environment map is exact", "[lights][emitters][envmap]") {
    for (const auto& [width, height] : {std::pair{16, 9}, {1, 1}, {2, 1}, {1, 2}, {3, 2}, {5, 40}}) {
        INFO(width << " x " << height);
        const EnvironmentPicture map(sky_picture(width, height));
        glm::dvec3 sum(0.0);
        constexpr int n = 480;
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < 2 * n; ++x) {
                const double v = (y + 0.5) / n;
                sum += glm::dvec3(map.eval(direction((x + 0.5) / (2 * n), v))) * std::sin(double(pi) * v);
            }
        sum *= double(pi) * double(pi) / double(n * n);
        for (int c = 0; c < 3; ++c) CHECK(map.integral()[c] == Approx(sum[c]).epsilon(2e-4));
    }
}

TEST_CASE("no lit direction has density zero", "[lights][emitters][envmap]") {
    Bitmap picture = black(12, 7);
    picture.pixels[12 * 3 + 11] = Rgb(0, 0, 1e-3f);  // next to the seam
    picture.pixels[2] = Rgb(1e-6f, 0, 0);            // at the pole
    picture.pixels[12 * 5 + 5] = Rgb(1e4f, 0, 0);
    const EnvironmentPicture map(picture);
    Rng rng(23);
    int lit = 0;
    for (int i = 0; i < 200000; ++i) {
        const Vec3 d = square_to_sphere(rng.next_vec2());
        if (is_black(map.eval(d))) continue;
        ++lit;
        REQUIRE(map.pdf_solid_angle(d) > 0.0f);
    }
    CHECK(lit > 10000);
}

TEST_CASE("one hot pixel is found", "[lights][emitters][envmap]") {
    Bitmap picture = black(64, 33);
    for (Rgb& c : picture.pixels) c = Rgb(1e-3f);
    picture.pixels[64 * 12 + 40] = Rgb(1e6f, 1e5f, 1e4f);
    const auto light = make_environment_map(picture);
    const EnvironmentPicture map(picture);
    MeanRgb mean;
    Rng rng(29);
    double largest = 0.0;
    for (int i = 0; i < 50000; ++i) {
        const auto s = light->sample_direct(Vec3(0.0f), rng.next_vec2());
        mean.add(s ? s->weight : Rgb(0.0f));
        if (s) largest = std::max(largest, double(s->weight.x));
    }
    CHECK(agree(mean, map.integral()));
    // A bilinear peak is at most four times the mean of its cell, a little more next to the poles.
    CHECK(largest < 5.0 * double(map.integral().x));
}

TEST_CASE("extreme environment maps", "[lights][emitters][envmap]") {
    const auto one = make_environment_map({1, 1, {Rgb(2.0f)}});
    CHECK(one->environment(glm::normalize(Vec3(1, 2, 3))) == Rgb(2.0f));
    CHECK(one->pdf_direct(Vec3(0.0f), Vec3(0, 1, 0), nullptr) == Approx(inv_four_pi));

    const auto dark = make_environment_map(black(4, 3));
    CHECK_FALSE(dark->sample_direct(Vec3(0.0f), Vec2(0.5f)));
    CHECK_FALSE(dark->sample_emission(Vec2(0.5f), Vec2(0.5f)));
    CHECK(dark->pdf_direct(Vec3(0.0f), Vec3(0, 1, 0), nullptr) == 0.0f);
    CHECK(dark->power() == Rgb(0.0f));

    for (const Vec3& d : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, -1), Vec3(-0.0f, 0, -1), Vec3(0, 0, 1),
                          Vec3(-1e-30f, 0, -1), Vec3(1e-30f, 1, -1e-30f)}) {
        const auto sky = make_environment_map(sky_picture());
        CHECK(is_finite(sky->environment(d)));
        const float pdf = sky->pdf_direct(Vec3(0.0f), d, nullptr);
        CHECK((std::isfinite(pdf) && pdf > 0.0f));
    }
    const EnvironmentPicture sky(sky_picture());
    for (const float x : {0.0f, one_minus_epsilon})
        for (const float y : {0.0f, one_minus_epsilon}) {
            const auto s = sky.sample(Vec2(x, y));
            CHECK(std::fabs(glm::length(s.direction) - 1.0f) < 1e-5f);
            CHECK((std::isfinite(s.pdf_solid_angle) && s.pdf_solid_angle > 0.0f));
        }
}

TEST_CASE("bad pixels are refused with their count and first position", "[lights][emitters][envmap]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {nan, infinity, -infinity, -0.001f}) {
        Bitmap picture = black(6, 4);
        picture.pixels[6 * 2 + 3].y = bad;
        picture.pixels[6 * 3 + 1].z = bad;
        const std::string message = message_of(picture);
        INFO(message);
        CHECK(message.find("2 pixels") != std::string::npos);
        CHECK(message.find("x = 3, y = 2") != std::string::npos);
    }
    CHECK(message_of({2, 2, {}}).find("no pixels") != std::string::npos);
    CHECK(message_of({0, 0, {}}).find("no pixels") != std::string::npos);
    CHECK_THROWS_AS(make_environment_map(black(2, 2), {}, -1.0f), InputError);
    CHECK_THROWS_AS(make_environment_map(black(2, 2), {}, nan), InputError);
}

TEST_CASE("real panoramas", "[lights][emitters][envmap][data]") {
    for (const char* file : {"env/openusd/StinsonBeach.hdr", "env/arnold-usd/rooftop_small.hdr"}) {
        const auto path = test_data(file);
        if (!path) continue;
        INFO(file);
        const auto light = make_environment_map(read_bitmap(*path, false));
        light->set_scene_bounds(Vec3(0.0f), 1.0f);
        CHECK(light->power().x > 0.0f);
        CHECK(agree(particle_power(*light, 100000), light->power()));
    }
}

TEST_CASE("a real picture with NaN and infinity is refused", "[lights][emitters][envmap][data]") {
    const auto path = test_data("env/openexr-images/TestImages/BrightRingsNanInf.exr");
    if (!path) return;
    CHECK_THROWS_AS(make_environment_map(read_bitmap(*path, false)), InputError);
}
