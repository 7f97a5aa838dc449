// Phase functions: normalised, sampled as they evaluate, forward means forward, stable at the extremes.
#include <array>

#include "core/math/frame.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"
#include "media/henyey_greenstein.h"
#include "media/phase_functions.h"
#include "tests/media/statistics.h"
#include "tests/support/catch.h"

using namespace mote;
using core::Vec2, core::Vec3;

namespace {
constexpr std::array<float, 15> asymmetries = {-0.999f, -0.9f, -0.5f, -1e-3f, -1e-4f, 0.0f,  1e-6f, 1e-4f,
                                               1e-3f,   0.1f,  0.5f,  0.8f,   0.95f,  0.99f, 0.999f};
const Vec3 viewer = glm::normalize(Vec3(0.3f, -0.5f, 0.7f));
}  // namespace

TEST_CASE("Henyey-Greenstein integrates to one", "[media][phase]") {
    for (const float g : asymmetries) {
        // substitute h = 2 x^4 so that the midpoint rule resolves the peak at h = 0; dh = 8 x^3 dx, 2 pi for
        // phi
        double sum = 0.0;
        const int n = 200000;
        for (int i = 0; i < n; ++i) {
            const double x = (i + 0.5) / n, h = 2.0 * x * x * x * x;
            sum += 2.0 * M_PI * media::henyey_greenstein(std::fabs(g), float(h)) * 8.0 * x * x * x / n;
        }
        INFO("g = " << g);
        CHECK(std::fabs(sum - 1.0) < 2e-5);
    }
}

TEST_CASE("forward scattering keeps the direction of travel", "[media][phase]") {
    const media::HenyeyGreensteinPhase forward(0.7f), backward(-0.7f);
    const float peak = 1.7f / (4.0f * core::pi * 0.3f * 0.3f);  // (1 - g^2) / (4 pi (1 - g)^3)
    CHECK(forward.eval(viewer, -viewer).x == Approx(peak).epsilon(1e-4));
    CHECK(backward.eval(viewer, viewer).x == Approx(peak).epsilon(1e-4));
    CHECK(forward.eval(viewer, viewer).x < forward.eval(viewer, -viewer).x);
    CHECK(forward.mean_cosine() == 0.7f);
}

TEST_CASE("the mean cosine of sampled directions is g", "[media][phase]") {
    for (const float g : asymmetries) {
        const media::HenyeyGreensteinPhase phase(g);
        core::Rng rng(17);
        tests::Mean cosine;
        for (int i = 0; i < 200000; ++i)
            cosine.add(-glm::dot(viewer, phase.sample(viewer, rng.next_vec2()).wi));
        INFO("g = " << g << ", mean " << cosine.value());
        CHECK(std::fabs(cosine.value() - g) < 0.01);
        CHECK(cosine.sigmas_from(g, 1e-6) < 5.0);
    }
}

TEST_CASE("phase sampling follows its density", "[media][phase]") {
    // Bins uniform in the distribution function of Henyey & Greenstein's cosine in double precision, so each
    // expects the same count, times eight bins in azimuth.
    for (const float g : {-0.9f, -0.3f, 1e-4f, 0.6f, 0.99f}) {
        const media::HenyeyGreensteinPhase phase(g);
        const core::Frame frame(-viewer);
        const int polar = 40, azimuthal = 8, n = 200000;
        std::vector<double> counts(polar * azimuthal, 0.0),
            expected(polar * azimuthal, double(n) / (polar * azimuthal));
        core::Rng rng(5);
        for (int i = 0; i < n; ++i) {
            const auto s = phase.sample(viewer, rng.next_vec2());
            const Vec3 local = frame.to_local(s.wi);
            const double a = g, cosine = local.z;
            // P(cos <= c) = (1 - a^2)/(2a) (1/sqrt(1 + a^2 - 2ac) - 1/(1 + a)), by its series near a = 0
            double cdf = (1 - a * a) / (2 * a) * (1 / std::sqrt(1 + a * a - 2 * a * cosine) - 1 / (1 + a));
            if (std::fabs(a) < 1e-3) cdf = 0.5 * (1 + cosine) + 0.75 * a * (cosine * cosine - 1);
            const double phi = std::atan2(local.y, local.x) / (2 * M_PI) + 0.5;
            const int bin_polar = std::clamp(int(cdf * polar), 0, polar - 1);
            counts[std::size_t(bin_polar * azimuthal + std::clamp(int(phi * azimuthal), 0, azimuthal - 1))] +=
                1;
            REQUIRE(s.pdf_solid_angle == phase.pdf_solid_angle(viewer, s.wi));
            REQUIRE(s.weight == core::Rgb(1.0f));
        }
        INFO("g = " << g);
        CHECK(tests::chi_squared_sigmas(counts, expected) < 4.0);
        // planted: directions of a slightly other g must be found out
        counts.assign(counts.size(), 0.0);
        const media::HenyeyGreensteinPhase wrong(g + 0.05f * (1.0f - std::fabs(g)));
        for (int i = 0; i < n; ++i) {
            const double cosine = frame.to_local(wrong.sample(viewer, rng.next_vec2()).wi).z, a = g;
            double cdf = (1 - a * a) / (2 * a) * (1 / std::sqrt(1 + a * a - 2 * a * cosine) - 1 / (1 + a));
            if (std::fabs(a) < 1e-3) cdf = 0.5 * (1 + cosine) + 0.75 * a * (cosine * cosine - 1);
            counts[std::size_t(std::clamp(int(cdf * polar), 0, polar - 1) * azimuthal + i % azimuthal)] += 1;
        }
        CHECK(tests::chi_squared_sigmas(counts, expected) > 4.0);
    }
}

TEST_CASE("phase functions are finite at the ends of the unit interval", "[media][phase]") {
    for (const float g : asymmetries)
        for (const float u : {0.0f, 1e-30f, 0.5f, core::one_minus_epsilon})
            for (const float v : {0.0f, core::one_minus_epsilon}) {
                const auto s = media::HenyeyGreensteinPhase(g).sample(viewer, {u, v});
                REQUIRE(core::is_finite(s.wi));
                REQUIRE(std::fabs(glm::length(s.wi) - 1.0f) < 1e-5f);
                REQUIRE(std::isfinite(s.pdf_solid_angle));
                REQUIRE(s.pdf_solid_angle > 0.0f);
            }
}

TEST_CASE("phase functions reject |g| >= 1", "[media][phase]") {
    for (const float g : {1.0f, -1.0f, 1.5f, std::nanf("")})
        CHECK_THROWS_AS(media::HenyeyGreensteinPhase(g), core::InputError);
}

TEST_CASE("the isotropic phase function covers the sphere evenly", "[media][phase]") {
    const media::IsotropicPhase phase;
    core::Rng rng(3);
    tests::Mean x, y, z, zz;
    for (int i = 0; i < 100000; ++i) {
        const auto s = phase.sample(viewer, rng.next_vec2());
        x.add(s.wi.x), y.add(s.wi.y), z.add(s.wi.z), zz.add(s.wi.z * s.wi.z);
        REQUIRE(s.pdf_solid_angle == phase.pdf_solid_angle(viewer, s.wi));
    }
    CHECK(std::fabs(x.value()) < 5 * x.standard_error());
    CHECK(std::fabs(y.value()) < 5 * y.standard_error());
    CHECK(std::fabs(z.value()) < 5 * z.standard_error());
    CHECK(zz.sigmas_from(1.0 / 3.0) < 5.0);
}
