// Homogeneous media: closed forms over twelve decades, distances, spectral weights, emission.
#include "media/homogeneous_medium.h"
#include "core/objects/error.h"
#include "media/phase_functions.h"
#include "tests/media/spectral_estimates.h"
#include "tests/support/catch.h"

using namespace mote;
using core::PathWeights, core::Ray, core::Rgb, core::Vec3;

namespace {

media::HomogeneousMedium medium(const Rgb& sigma_t, const Rgb& albedo, const Rgb& radiance = Rgb(0.0f)) {
    return {sigma_t, sigma_t * albedo, radiance, std::make_shared<media::IsotropicPhase>()};
}
Ray segment(float length) { return {Vec3(0), Vec3(0, 0, 1), 0.0f, length}; }

}  // namespace

TEST_CASE("homogeneous transmittance is exact over twelve decades", "[media][homogeneous]") {
    core::Rng rng(1);
    core::TrackingCounters counters;
    for (double tau = 1e-6; tau < 2e6; tau *= 10.0)
        for (const float length : {1e-3f, 1.0f, 1e5f}) {
            const float sigma = float(tau / length);
            const float t = medium(Rgb(sigma), Rgb(0.5f)).transmittance(segment(length), rng, counters).x;
            const double exact = std::exp(-double(sigma) * length);
            INFO("optical depth " << tau << ", length " << length);
            if (exact > 1.2e-38)
                CHECK(std::fabs(t - exact) < 1e-6 * exact);
            else
                CHECK(t <= 1.2e-38f);
            // the depth itself, where the medium is thin: rounding 1 - tau to a float costs 6e-8
            if (tau < 1e-3) CHECK(std::fabs((1.0 - t) - (1.0 - exact)) < 7e-8);
        }
}

TEST_CASE("vacuum of infinite length transmits everything", "[media][homogeneous]") {
    core::Rng rng(1);
    core::TrackingCounters counters;
    const auto m = medium(Rgb(0.0f, 0.0f, 1.0f), Rgb(0.5f));
    const Ray ray = segment(core::infinity);
    CHECK(m.transmittance(ray, rng, counters) == Rgb(1, 1, 0));
    for (int hero = 0; hero < 3; ++hero) {
        PathWeights w;
        w.light = Rgb(1.0f);  // as after a scattering of density 1
        w.hero = hero;
        Rgb emitted(0.0f);
        const auto t = m.sample_collision(ray, w, emitted, rng, counters);
        CHECK(t.has_value() == (hero == 2));
        if (!t) CHECK(w.throughput == Rgb(1, 1, 0));
        CHECK(core::is_finite(w.throughput));
        CHECK(core::is_finite(w.unidirectional));
        CHECK(core::is_finite(w.light));
    }
}

TEST_CASE("homogeneous distances follow the truncated exponential", "[media][homogeneous]") {
    const double sigma = 1.7, length = 2.0;
    const auto m = medium(Rgb(float(sigma)), Rgb(0.8f));
    const auto sample = [&](double stretch) {
        core::Rng rng(11);
        core::TrackingCounters counters;
        std::vector<double> distances;
        for (int i = 0; i < 100000; ++i) {
            PathWeights w;
            w.light = Rgb(1.0f);  // as after a scattering of density 1
            Rgb emitted(0.0f);
            if (const auto t = m.sample_collision(segment(float(length)), w, emitted, rng, counters))
                distances.push_back(*t * stretch);
        }
        return distances;
    };
    const auto cdf = [&](double t) { return std::expm1(-sigma * t) / std::expm1(-sigma * length); };
    CHECK(tests::kolmogorov_smirnov_p(sample(1.0), cdf) > 1e-4);
    CHECK(tests::kolmogorov_smirnov_p(sample(1.02), cdf) < 1e-4);  // planted: two per cent too long
}

TEST_CASE("collisions in a very thin medium are as rare as they must be", "[media][homogeneous]") {
    // 24-bit random numbers would make these 1.3 % too frequent: 2e7 samples, 5 sigma = 112 of 500 expected
    const auto m = medium(Rgb(2.5e-5f), Rgb(1.0f));
    core::Rng rng(2);
    core::TrackingCounters counters;
    const int n = 20'000'000;
    for (int i = 0; i < n; ++i) {
        PathWeights w;
        w.light = Rgb(1.0f);  // as after a scattering of density 1
        Rgb emitted(0.0f);
        m.sample_collision(segment(1.0f), w, emitted, rng, counters);
    }
    CHECK(std::fabs(double(counters.collisions) - 2.5e-5 * n) < 5.0 * std::sqrt(2.5e-5 * n));
}

TEST_CASE("spectral weights of a homogeneous medium are unbiased", "[media][homogeneous][spectral]") {
    const Rgb sigma(0.03f, 1.0f, 3.0f), albedo(0.9f, 0.5f, 0.2f);
    const auto m = medium(sigma, albedo);
    const Ray ray = segment(1.3f);
    const auto e = tests::spectral_estimates(m, ray, 200000, 7);
    for (int c = 0; c < 3; ++c) {
        const double t = std::exp(-double(sigma[c]) * 1.3);
        INFO("channel " << c);
        CHECK(e.escape[c].sigmas_from(t) < 5.0);
        CHECK(e.collision[c].sigmas_from(albedo[c] * (1.0 - t)) < 5.0);
        CHECK(e.two_techniques[c].sigmas_from(t) < 5.0);
        CHECK(e.connection[c].sigmas_from(t, 1e-6) < 5.0);
    }
}

TEST_CASE("a channel without extinction as hero leaves the estimate unbiased",
          "[media][homogeneous][spectral]") {
    const Rgb sigma(0.0f, 2.0f, 0.5f), albedo(0.7f);
    const auto m = medium(sigma, albedo);
    const auto e = tests::spectral_estimates(m, segment(1.0f), 200000, 8);
    for (int c = 0; c < 3; ++c) {
        const double t = std::exp(-double(sigma[c]));
        CHECK(e.escape[c].sigmas_from(t) < 5.0);
        CHECK(e.collision[c].sigmas_from(0.7 * (1.0 - t)) < 5.0);
        CHECK(e.two_techniques[c].sigmas_from(t) < 5.0);
    }
}

TEST_CASE("an emitting slab has its closed form", "[media][homogeneous][emission]") {
    const Rgb sigma(0.0f, 1e-6f, 4.0f), radiance(3.0f, 2.0f, 5.0f);
    const auto m = medium(sigma, Rgb(0.0f), radiance);
    core::Rng rng(4);
    core::TrackingCounters counters;
    PathWeights w;
    w.light = Rgb(1.0f);  // as after a scattering of density 1
    Rgb emitted(0.0f);
    m.sample_collision(segment(0.5f), w, emitted, rng, counters);
    for (int c = 0; c < 3; ++c)
        CHECK(emitted[c] == Approx(-radiance[c] * std::expm1(-double(sigma[c]) * 0.5)).epsilon(1e-6));
    emitted = Rgb(0.0f), w = {}, w.hero = 2;
    m.sample_collision(segment(core::infinity), w, emitted, rng, counters);
    CHECK(emitted.z == Approx(5.0));
    CHECK(emitted.x == 0.0f);
}

TEST_CASE("homogeneous media refuse impossible coefficients", "[media][homogeneous]") {
    CHECK_THROWS_AS(medium(Rgb(-1.0f), Rgb(0.5f)), core::InputError);
    CHECK_THROWS_AS(medium(Rgb(1.0f), Rgb(1.5f)), core::InputError);
    CHECK_THROWS_AS(medium(Rgb(core::infinity), Rgb(0.5f)), core::InputError);
    CHECK_THROWS_AS(medium(Rgb(1.0f), Rgb(0.5f), Rgb(-1.0f)), core::InputError);
}

TEST_CASE("a homogeneous medium describes itself", "[media][homogeneous]") {
    const auto grey = medium(Rgb(2.0f), Rgb(0.5f)).traits();
    CHECK(grey.homogeneous);
    CHECK_FALSE(grey.chromatic);
    CHECK(grey.scattering);
    CHECK(grey.isotropic);
    CHECK_FALSE(grey.emissive);
    CHECK(medium(Rgb(1, 2, 3), Rgb(0.5f)).traits().chromatic);
    CHECK(medium(Rgb(0.0f), Rgb(0.5f)).traits().empty);
    CHECK_FALSE(medium(Rgb(1.0f), Rgb(0.0f)).traits().scattering);
    CHECK(medium(Rgb(1.0f), Rgb(0.0f), Rgb(1.0f)).traits().emissive);
}
