// The two fractions of a bounded geometry term add up to one at every extreme, and distances inside the
// region follow their density from vacuum to lead.
#include "compensation/bounded_geometry.h"

#include "compensation/expected_loss.h"
#include "compensation/region_distance.h"
#include "core/math/random.h"
#include "tests/support/catch.h"
#include "tests/support/chi2_distance.h"

using namespace mote;
using namespace mote::compensation;
using namespace mote::tests;

TEST_CASE("bounded and residual fractions add up to one", "[compensation][bound]") {
    core::Rng rng(1);
    for (int i = 0; i < 100000; ++i) {
        const float cosines = rng.next_float();
        const float distance = std::pow(10.0f, 40.0f * rng.next_float() - 20.0f);
        const float bound = std::pow(10.0f, 76.0f * rng.next_float() - 38.0f);
        const float kept = bounded_factor(cosines, distance, bound);
        const float taken = residual_factor(cosines, distance, bound);
        REQUIRE(kept >= 0.0f);
        REQUIRE(kept <= 1.0f);
        REQUIRE(taken >= 0.0f);
        REQUIRE(kept + taken == Approx(1.0f).margin(1e-6));
    }
}

TEST_CASE("fractions agree with the definition of the bound in double precision", "[compensation][bound]") {
    core::Rng rng(2);
    for (int i = 0; i < 20000; ++i) {
        const float cosines = rng.next_float(), distance = 0.01f + 3.0f * rng.next_float();
        const float bound = 10.0f * rng.next_float();
        const double g = double(cosines) / (double(distance) * double(distance));
        const double residual = g > 0.0 ? std::max(0.0, g - double(bound)) / g : 0.0;
        REQUIRE(residual_factor(cosines, distance, bound) == Approx(residual).margin(1e-5));
        // G* B* without the bound subtracted, as Eq. 10.10 prints it, is another number.
        if (g > 2.0 * double(bound) && bound > 0.1f) REQUIRE(residual < 1.0);
    }
}

TEST_CASE("limits of the bound", "[compensation][bound]") {
    for (const float d : {0.0f, 1e-20f, 1.0f, 1e15f}) {
        CHECK(residual_factor(1.0f, d, 0.0f) == 1.0f);
        CHECK(residual_factor(1.0f, d, core::infinity) == 0.0f);
        CHECK(bounded_factor(1.0f, d, core::infinity) == 1.0f);
        CHECK(residual_factor(0.0f, d, 1.0f) == 0.0f);
    }
    CHECK(residual_factor(0.5f, 0.0f, 4.0f) == 1.0f);
    CHECK(bounding_radius(4.0f) == 0.5f);
    // The region's edge: inside something is taken, outside nothing.
    CHECK(residual_factor(1.0f, 0.499f, 4.0f) > 0.0f);
    CHECK(residual_factor(1.0f, 0.501f, 4.0f) == 0.0f);
}

TEST_CASE("the expected loss is the integral that it represents", "[compensation][loss]") {
    for (const double sigma_t : {1e-6, 1e-3, 0.1, 0.499, 0.501, 3.0, 100.0})
        for (const double bound : {0.25, 1.0, 1e4}) {
            const double radius = 1.0 / std::sqrt(bound), sigma_s = 0.9 * sigma_t;
            double sum = 0.0;
            constexpr int n = 200000;
            for (int i = 0; i < n; ++i) {
                const double t = (i + 0.5) * radius / n;
                sum += sigma_s * std::exp(-sigma_t * t) * (1.0 - bound * t * t) * radius / n;
            }
            CHECK(residual_fraction(sigma_t, sigma_s, bound) == Approx(sum).epsilon(1e-6));
        }
    CHECK(residual_fraction(0.0, 0.0, 1.0) == 0.0);
    CHECK(residual_fraction(1.0, 0.9, core::infinity) == 0.0);
    CHECK(residual_fraction(1.0, 0.9, 0.0) == 0.9);
    const ExpectedMedium lead{2.0, 1.8, 1e6};  // light never leaves it: beta_all is the albedo
    CHECK(lead.beta_all() == Approx(0.9));
    CHECK(expected_loss(lead, 4.0, 0) == Approx(lead.beta(4.0) / 0.9));
    CHECK(expected_loss(lead, 4.0, 2) == Approx(std::pow(lead.beta(4.0), 3) / 0.9));
    CHECK(expected_loss(lead, 4.0, -1) == 0.0);
    CHECK(expected_loss({}, 4.0, 0) == 0.0);
    // A region larger than the medium holds all that there is, and no more.
    CHECK(expected_loss({0.01, 0.01, 0.1}, 1e-4, 0) == 1.0);
    for (const int steps : {0, 1, 3}) {
        const double b = bound_for_loss(lead, steps, 0.02);
        CHECK(expected_loss(lead, b, steps) == Approx(0.02).epsilon(1e-3));
    }
    CHECK(bound_for_loss({2.0, 0.01, 1e6}, 1, 0.02) == 0.0);
}

TEST_CASE("distances in the region follow their density", "[compensation][distances]") {
    for (const float limit : {1e-4f, 1.0f, 1e4f})
        for (const float depth : {0.0f, 1e-9f, 1e-6f, 1e-3f, 0.3f, 1.0f, 10.0f, 80.0f, 1e6f}) {
            const RegionDistance region(depth / limit, limit);
            DistanceOptions options;
            options.name = "region_distance";
            options.lower = 0.0, options.tests = 30, options.samples = 20000;
            // Bins where the samples are: at most forty mean free paths.
            options.upper = double(limit) * std::min(1.0, 40.0 / std::max(double(depth), 1e-30));
            const double reached = depth > 0.0f ? -std::expm1(-double(depth)) : 1.0;
            const Chi2Result result = chi2_distance_test(
                [&](core::Rng& rng) { return std::optional<double>(region.sample(rng.next_float())); },
                [&](double t) {
                    const double x = double(depth) * t / double(limit);
                    return depth > 0.0f ? -std::expm1(-x) / reached : t / double(limit);
                },
                options);
            INFO(depth << " over " << limit << "\n" << result.message);
            CHECK(result.passed);
            // The density is the derivative of the distribution, and finite.
            for (const float fraction : {0.0f, 0.1f, 0.5f, 1.0f}) {
                const double t = double(fraction) * double(limit), s = double(depth) / double(limit);
                const double exact = depth > 0.0f ? s * std::exp(-s * t) / reached : 1.0 / double(limit);
                CHECK(double(region.pdf_distance(float(t))) == Approx(exact).epsilon(1e-4).margin(1e-30));
            }
        }
}

TEST_CASE("distances as printed in Eq. 10.14 are negative, and their limit is uniform",
          "[compensation][distances]") {
    const RegionDistance thick(3.0f, 2.0f);
    CHECK(thick.sample(0.0f) == 0.0f);
    CHECK(thick.sample(0.99999994f) <= 2.0f);
    float last = 0.0f;
    for (int i = 1; i < 1000; ++i) {
        const float t = thick.sample(float(i) / 1000.0f);
        REQUIRE(t > last);
        last = t;
    }
    // Smooth across the switch to the uniform limit.
    for (const float u : {0.1f, 0.5f, 0.9f}) {
        const float below = RegionDistance(0.99e-6f, 1.0f).sample(u),
                    above = RegionDistance(1.01e-6f, 1.0f).sample(u);
        CHECK(below == Approx(u).epsilon(1e-6));
        CHECK(above == Approx(u).epsilon(2e-6));
    }
    CHECK(RegionDistance(2.0f, core::infinity).sample(0.5f) == Approx(std::log(2.0) / 2.0));
}
