// The emission of a medium as a light samples what it claims: directions to it, points of it, and directions
// of its particles, by chi-square tests against its density of points p_V. It is no type of the scene
// language, so no registered type represents it.
#include "media/medium_emitter.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"
#include "tests/support/chi2_distance.h"

using namespace mote;
using namespace mote::tests;
using core::Rgb, core::Vec3;

namespace {

/// Glowing everywhere in the unit cube, brighter in some places than in others.
struct Glow {
    std::shared_ptr<media::HeterogeneousMedium> medium;
    std::unique_ptr<media::MediumEmitter> light;

    Glow() {
        media::MediumParts parts = medium_parts(Rgb(0.2f));
        parts.emission.radiance = std::make_shared<media::ConstantVolume>(Rgb(1.0f));
        medium = medium_of(
            vol_grid({5, 5, 5}, 1,
                     [](int x, int y, int z) { return Rgb(0.2f + (x * y == 6 ? 8.0f : 0.0f) + 0.3f * z); }),
            parts);
        light = std::make_unique<media::MediumEmitter>(*medium, core::Bounds3{Vec3(0.0f), Vec3(1.0f)}, true);
        light->set_direct_probability(1.0f);
    }
    /// p_V(y) d^2 [1/(sr m)]: light_over_walk() where the extinction is one.
    double pdf_along(const Vec3& from, const Vec3& y) const {
        return double(light->light_over_walk(from, y, Rgb(1.0f)));
    }
};

const Vec3 receiver(0.4f, -0.3f, -1.2f);

/// Density of directions: the integral of p_V d^2 along the ray. The cube lies within 3 m.
double direction_density(const Glow& glow, const Vec3& w) {
    constexpr int steps = 80;
    const float near = 1.0f, far = 3.0f, h = (far - near) / steps;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i)
        sum += glow.pdf_along(receiver, receiver + (near + (float(i) + 0.5f) * h) * w);
    return sum * double(h);
}

Chi2Options direction_options(const std::string& name) {
    Chi2Options o;
    o.name = "medium_emitter_" + name;
    o.samples = 60000, o.cos_cells = 8, o.phi_cells = 16, o.tests = 5;
    return o;
}
Chi2Options towards_the_cube(const std::string& name) {
    Chi2Options o = direction_options(name);
    o.frame = core::Frame(glm::normalize(Vec3(0.52f, 0.47f, 0.5f) - receiver));
    o.cap = 0.2;
    return o;
}

/// Density of the coordinate `axis` of points: p_V averaged over slabs, two for each of its 32 cells.
DistanceCdf marginal(const Glow& glow, int axis) {
    constexpr int n = 64;
    std::vector<double> slabs(n, 0.0);
    for (int i = 0; i < n * n * n; ++i) {
        const Vec3 p = (Vec3(float(i % n), float(i / n % n), float(i / (n * n))) + 0.5f) / float(n);
        slabs[std::size_t(p[axis] * n)] += double(glow.light->pdf_emission(p, {}, {}).pdf_area) / (n * n);
    }
    return cdf_of_density([=](double t) { return slabs[std::size_t(t * n)]; }, 0.0, 1.0, n);
}

DistanceSampler coordinate(const Glow& glow, int axis) {
    return [&glow, axis](core::Rng& rng) -> std::optional<double> {
        const core::Vec2 u = rng.next_vec2();
        const auto s = glow.light->sample_emission(u, rng.next_vec2());
        // The box is padded by a millionth.
        return s ? std::optional<double>(std::clamp(double(s->origin[axis]), 0.0, 1.0)) : std::nullopt;
    };
}

}  // namespace

TEST_CASE("connections to a glowing medium follow its density of points", "[media][emission][chi2]") {
    const Glow glow;
    const auto sampled = [&](core::Rng& rng) -> std::optional<Vec3> {
        const auto s = glow.light->sample_direct(receiver, rng.next_vec2());
        return s ? std::optional<Vec3>(s->wi) : std::nullopt;
    };
    const auto density = [&](const Vec3& w) { return direction_density(glow, w); };
    Chi2Options o = towards_the_cube("direct");
    const Chi2Result result = chi2_test(sampled, density, o);
    INFO(result.message);
    CHECK(result.passed);
    core::Rng rng(3);
    for (int i = 0; i < 1000; ++i) {
        const auto s = glow.light->sample_direct(receiver, rng.next_vec2());
        REQUIRE(s);
        REQUIRE(s->pdf_solid_angle ==
                Approx(glow.pdf_along(receiver, receiver + s->distance * s->wi)).epsilon(1e-4));
    }
    // Planted: the density three per cent off, and the squared distance forgotten.
    o.write_table = false;
    CHECK_FALSE(chi2_test(
                    sampled, [&](const Vec3& w) { return 0.97 * density(w); }, o)
                    .passed);
    const auto flat = [&](const Vec3& w) {
        double sum = 0.0;
        for (int i = 0; i < 80; ++i) {
            const float t = 1.0f + (float(i) + 0.5f) / 40.0f;
            sum += glow.pdf_along(receiver, receiver + t * w) / double(t * t) / 40.0;
        }
        return sum;
    };
    CHECK_FALSE(chi2_test(sampled, flat, o).passed);
}

TEST_CASE("particles of a glowing medium start by its density of points, in all directions",
          "[media][emission][chi2]") {
    const Glow glow;
    for (int axis = 0; axis < 3; ++axis) {
        DistanceOptions o;
        o.name = "medium_emitter_axis_" + std::to_string(axis), o.bins = 32, o.tests = 5;
        const Chi2Result result = chi2_distance_test(coordinate(glow, axis), marginal(glow, axis), o);
        INFO(result.message);
        CHECK(result.passed);
        // Planted: the density of another axis.
        o.write_table = false;
        if (axis == 2) CHECK_FALSE(chi2_distance_test(coordinate(glow, 2), marginal(glow, 0), o).passed);
    }
    const auto direction = [&](core::Rng& rng) -> std::optional<Vec3> {
        const core::Vec2 u = rng.next_vec2();
        const auto s = glow.light->sample_emission(u, rng.next_vec2());
        return s ? std::optional<Vec3>(s->direction) : std::nullopt;
    };
    const auto density = [&](const Vec3& w) {
        return double(glow.light->pdf_emission(Vec3(0.5f), {}, w).pdf_solid_angle);
    };
    const Chi2Result result = chi2_test(direction, density, direction_options("directions"));
    INFO(result.message);
    CHECK(result.passed);
    core::Rng rng(4);
    for (int i = 0; i < 1000; ++i) {
        const core::Vec2 u = rng.next_vec2();
        const auto s = glow.light->sample_emission(u, rng.next_vec2());
        REQUIRE(s);
        const core::EmissionDensity pdf = glow.light->pdf_emission(s->origin, s->normal, s->direction);
        REQUIRE(pdf.pdf_area == Approx(s->pdf_area).epsilon(1e-5));
        REQUIRE(pdf.pdf_solid_angle == s->pdf_solid_angle);
        // The density of points is that of connections, by another way.
        const float squared = glm::dot(s->origin - receiver, s->origin - receiver);
        REQUIRE(double(pdf.pdf_area * squared) == Approx(glow.pdf_along(receiver, s->origin)).epsilon(1e-4));
    }
    CHECK(glow.light->pdf_emission(Vec3(0.5f, 1.1f, 0.5f), {}, {}).pdf_area == 0.0f);
}

// Two techniques find a point y of the medium: a direction of density p_w that a walk collides in, and a
// point sampled of density p_V. The weights add up to one only where both sides count per length of the ray
// with the same c(y).
TEST_CASE("light sampling and walks into a glowing medium weight each other by the same density",
          "[media][emission]") {
    const Glow glow;
    constexpr float chance = 0.3f;
    glow.light->set_direct_probability(chance);
    core::Rng rng(12);
    for (int i = 0; i < 200; ++i) {
        const Vec3 from = 3.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - 1.0f;
        const auto s = glow.light->sample_direct(from, rng.next_vec2());
        REQUIRE(s);
        const Vec3 y = from + s->distance * s->wi;
        const Rgb sigma_t = glow.medium->coefficients(y).sigma_t;
        // Density of light sampling over that of directions of density 1/sr, as direct_light.cpp and a walk
        // need it.
        const float by_light = chance * s->pdf_solid_angle / s->line_density;
        const float by_walk = glow.light->light_over_walk(from, y, sigma_t);
        // The point is rebuilt from its direction: some ulps of the distance, and of the extinction that
        // varies there.
        CHECK(by_light == Approx(by_walk).epsilon(1e-3));
        // The point's density is per volume: with d^2 it is one per solid angle and length.
        const float p_v = glow.light->pdf_emission(y, {}, {}).pdf_area;
        CHECK(s->pdf_solid_angle == Approx(p_v * s->distance * s->distance).epsilon(1e-3));
    }
}
