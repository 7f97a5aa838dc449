// Tracking through dense grids: against closed forms, quadrature, and with planted errors.
#include "core/objects/error.h"
#include "media/blackbody.h"
#include "media/homogeneous_medium.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using core::PathWeights, core::Ray, core::Rgb, core::Vec3, core::Vec3d;

namespace {

/// Oblique through the unit cube, from within it to within it.
const Ray oblique{Vec3(0.05f, 0.1f, 0.15f), glm::normalize(Vec3(0.8f, 0.7f, 0.6f)), 0.0f, 1.05f};

double refined_depth_error(const core::Medium& m, const Ray& ray) {
    return glm::length(tests::quadrature_depth(m, ray, ray.t_max, 20000) -
                       tests::quadrature_depth(m, ray, ray.t_max, 10000));
}

}  // namespace

TEST_CASE("a constant grid is the homogeneous medium, channels 1:100 apart", "[media][heterogeneous]") {
    const Rgb sigma(0.05f, 1.0f, 5.0f), albedo(0.9f, 0.6f, 0.3f);
    const auto grid = tests::medium_of(tests::vol_grid({5, 6, 7}, 3, [&](int, int, int) { return sigma; }),
                                       tests::medium_parts(albedo));
    const auto constant = media::ConstantVolume(sigma).make_medium(tests::medium_parts(albedo));
    const media::HomogeneousMedium closed(sigma, sigma * albedo, Rgb(0.0f),
                                          std::make_shared<media::IsotropicPhase>());
    const Vec3d tau = Vec3d(sigma) * double(oblique.t_max);
    CHECK(tests::worst_sigmas(tests::spectral_estimates(closed, oblique, 100000, 1), tau, albedo) < 5.0);
    CHECK(tests::worst_sigmas(tests::spectral_estimates(*grid, oblique, 100000, 2), tau, albedo) < 5.0);
    CHECK(tests::worst_sigmas(tests::spectral_estimates(*constant, oblique, 100000, 3), tau, albedo) < 5.0);
    CHECK(grid->traits().chromatic);
    // residual tracking leaves nothing random: the same number every time
    core::Rng rng(4);
    core::TrackingCounters counters;
    for (int i = 0; i < 10; ++i) {
        const Rgb t = grid->transmittance(oblique, rng, counters);
        for (int c = 0; c < 3; ++c) CHECK(t[c] == Approx(std::exp(-tau[c])).epsilon(1e-5));
    }
}

TEST_CASE("constant grids are exact over twelve decades", "[media][heterogeneous]") {
    core::Rng rng(1);
    core::TrackingCounters counters;
    for (double tau = 1e-6; tau < 2e6; tau *= 10.0) {
        const auto m = tests::medium_of(tests::vol_grid({9, 9, 9}, 1, [](int, int, int) { return Rgb(1); }),
                                        tests::medium_parts(Rgb(0.5f), float(tau / oblique.t_max)));
        const double exact = std::exp(-tau), t = m->transmittance(oblique, rng, counters).x;
        INFO("optical depth " << tau);
        if (exact > 1.2e-38)
            CHECK(std::fabs(t - exact) < 1e-5 * exact);
        else
            CHECK(t <= 1.2e-38);
        CHECK(m->optical_depth_by_marching(oblique, 0.01f, counters).y == Approx(tau).epsilon(1e-5));
    }
    CHECK(counters.fallbacks == 0);
}

TEST_CASE("tracking through random grids agrees with quadrature", "[media][heterogeneous]") {
    for (const int channels : {1, 3})
        for (const glm::ivec3& n :
             {glm::ivec3(1), glm::ivec3(2, 1, 3), glm::ivec3(8), glm::ivec3(20, 13, 31)}) {
            const Rgb albedo(0.8f, 0.7f, 0.2f);
            const auto m = tests::medium_of(tests::random_grid(n, channels, 99), tests::medium_parts(albedo));
            const Vec3d tau = tests::quadrature_depth(*m, oblique, oblique.t_max, 20000);
            INFO(channels << " channels, " << n.x << "x" << n.y << "x" << n.z);
            REQUIRE(refined_depth_error(*m, oblique) < 1e-5);
            const auto e = tests::spectral_estimates(*m, oblique, 60000, 5);
            CHECK(tests::worst_sigmas(e, tau, albedo, 2e-5) < 5.0);
            core::TrackingCounters counters;
            CHECK(glm::length(m->optical_depth_by_marching(oblique, 1e-4f, counters) - tau) < 1e-4);
        }
}

TEST_CASE("a majorant that is too low is caught", "[media][heterogeneous][planted]") {
    const Rgb albedo(0.8f);
    const auto sigmas = [&](float factor) {
        auto parts = tests::medium_parts(albedo, 3.0f);
        parts.plant_majorant_factor = factor;
        parts.tracking.transmittance = media::TransmittanceEstimator::ratio_tracking;  // reads majorants
        // A peak in every cell, so that the bound is met
        const auto m = tests::medium_of(
            tests::vol_grid({12, 12, 12}, 1,
                            [](int x, int y, int z) { return Rgb((x + y + z) % 3 ? 1.0f : 0.6f); }),
            parts);
        const Vec3d tau = tests::quadrature_depth(*m, oblique, oblique.t_max, 20000);
        return tests::worst_sigmas(tests::spectral_estimates(*m, oblique, 200000, 5), tau, albedo);
    };
    CHECK(sigmas(1.0f) < 5.0);
    CHECK(sigmas(0.9f) > 5.0);
}

TEST_CASE("cell bounds hold everywhere and are met somewhere", "[media][heterogeneous]") {
    const auto file = tests::random_grid({17, 9, 26}, 1, 3);
    const media::DenseVoxels voxels{file.resolution, 1, file.values};
    const auto majorants = media::dense_majorants<float>(voxels);
    core::Rng rng(6);
    std::size_t checked = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d o(30 * rng.next_float() - 5, 20 * rng.next_float() - 5, 35 * rng.next_float() - 5);
        Vec3d d(rng.next_float() - 0.5, rng.next_float() - 0.5, rng.next_float() - 0.5);
        if (i % 7 == 0) d[i % 3] = 0.0;
        if (i % 11 == 0) d[(i + 1) % 3] = 0.0;
        if (glm::length(d) == 0.0) continue;
        double covered = 0.0, last = -40.0;
        majorants.walk(o, d, -40.0, 40.0, [&](const auto& range, double t0, double t1) {
            REQUIRE(t0 >= last);
            REQUIRE(t1 > t0);
            covered += t1 - t0, last = t1;
            for (const double f : {0.0, 0.3, 0.9, 1.0}) {
                const float v = voxels.interpolate<float>(o + (t0 + f * (t1 - t0)) * d);
                REQUIRE(v <= range.upper * 1.000001f);
                REQUIRE(v >= range.lower * 0.999999f);
                ++checked;
            }
            return true;
        });
        REQUIRE(covered == Approx(80.0).epsilon(1e-9));
    }
    CHECK(checked > 100000);
    CHECK(majorants.total().upper == *std::max_element(file.values.begin(), file.values.end()));
}

TEST_CASE("heterogeneous distances follow their density", "[media][heterogeneous]") {
    const auto m =
        tests::medium_of(tests::random_grid({6, 6, 6}, 1, 12), tests::medium_parts(Rgb(0.5f), 2.0f));
    const int steps = 20000;
    std::vector<double> depth(steps + 1, 0.0);
    const double h = double(oblique.t_max) / steps;
    for (int i = 0; i < steps; ++i)
        depth[std::size_t(i) + 1] =
            depth[std::size_t(i)] + h * m->coefficients(oblique.at(float((i + 0.5) * h))).sigma_t.x;
    const auto cdf = [&](double t) {
        const double x = std::clamp(t / h, 0.0, double(steps)), i = std::min(std::floor(x), steps - 1.0);
        const double tau =
            depth[std::size_t(i)] + (x - i) * (depth[std::size_t(i) + 1] - depth[std::size_t(i)]);
        return std::expm1(-tau) / std::expm1(-depth.back());
    };
    core::Rng rng(21);
    core::TrackingCounters counters;
    std::vector<double> distances, biased;
    for (int i = 0; i < 100000; ++i) {
        PathWeights w;
        w.light = Rgb(1.0f);  // as after a scattering of density 1
        Rgb emitted(0.0f);
        if (const auto t = m->sample_collision(oblique, w, emitted, rng, counters)) {
            distances.push_back(*t);
            biased.push_back(*t * 1.02);
        }
        REQUIRE(w.unidirectional == Rgb(1.0f));
    }
    const double expected = 100000 * -std::expm1(-depth.back());
    CHECK(std::fabs(double(distances.size()) - expected) < 5.0 * std::sqrt(expected));
    CHECK(tests::kolmogorov_smirnov_p(distances, cdf) > 1e-4);
    CHECK(tests::kolmogorov_smirnov_p(biased, cdf) < 1e-4);
}

TEST_CASE("an absorbing and emitting slab has its closed form", "[media][heterogeneous][emission]") {
    // L = L_e (1 - exp(-tau)) without scattering; with scattering only the absorbed share emits
    const Rgb sigma(0.2f, 1.0f, 4.0f), radiance(2.0f, 1.0f, 3.0f);
    for (const float albedo : {0.0f, 0.5f}) {
        auto parts = tests::medium_parts(Rgb(albedo));
        parts.emission.radiance = std::make_shared<media::ConstantVolume>(radiance);
        const auto file = tests::vol_grid({4, 4, 4}, 3, [&](int, int, int) { return sigma; });
        const auto grid = tests::medium_of(file, parts);
        const media::HomogeneousMedium closed(sigma, sigma * albedo, radiance, parts.phase);
        const auto a = tests::spectral_estimates(*grid, oblique, 200000, 3);
        const auto b = tests::spectral_estimates(closed, oblique, 1000, 4);
        for (std::size_t c = 0; c < 3; ++c) {
            const double exact =
                radiance[int(c)] * (1.0 - albedo) * -std::expm1(-double(sigma[int(c)]) * oblique.t_max);
            INFO("albedo " << albedo << ", channel " << c);
            CHECK(a.emitted[c].sigmas_from(exact) < 5.0);
            CHECK(b.emitted[c].sigmas_from(exact, 1e-5) < 5.0);
        }
    }
}

TEST_CASE("black bodies shine as Planck says", "[media][emission]") {
    CHECK(media::blackbody_rgb(90.0) == Rgb(0.0f));
    const Rgb ember = media::blackbody_rgb(1500.0), sun = media::blackbody_rgb(5772.0),
              star = media::blackbody_rgb(20000.0);
    CHECK(ember.x > 5.0f * ember.y);
    CHECK(star.z > star.x);
    // the sun's chromaticity is published as x = 0.326, y = 0.335: from Rec. 709 back to x
    const double x = 0.4124564 * sun.x + 0.3575761 * sun.y + 0.1804375 * sun.z;
    const double y = 0.2126729 * sun.x + 0.7151522 * sun.y + 0.0721750 * sun.z;
    const double z = 0.0193339 * sun.x + 0.1191920 * sun.y + 0.9503041 * sun.z;
    CHECK(x / (x + y + z) == Approx(0.326).margin(0.004));
    CHECK(y / (x + y + z) == Approx(0.335).margin(0.004));
    const media::BlackbodyTable table(4000.0);
    for (const float kelvin : {500.0f, 1234.0f, 2999.0f, 4000.0f})
        CHECK(table.at(kelvin).x == Approx(media::blackbody_rgb(kelvin).x).epsilon(0.01).margin(1e-6));
}

TEST_CASE("extreme grids: zero, one voxel, steps of a million to one", "[media][heterogeneous]") {
    core::Rng rng(1);
    core::TrackingCounters counters;
    const auto empty = tests::medium_of(tests::vol_grid({5, 5, 5}, 1, [](int, int, int) { return Rgb(0); }),
                                        tests::medium_parts(Rgb(0.5f)));
    CHECK(empty->traits().empty);
    const Ray endless{Vec3(-3, 0.5f, 0.5f), Vec3(1, 0, 0), 0.0f, core::infinity};
    CHECK(empty->transmittance(endless, rng, counters) == Rgb(1.0f));
    PathWeights w;
    w.light = Rgb(1.0f);  // as after a scattering of density 1
    Rgb emitted(0.0f);
    CHECK_FALSE(empty->sample_collision(endless, w, emitted, rng, counters));
    CHECK(w.throughput == Rgb(1.0f));
    CHECK(counters.lookups == 0);

    const auto spike = [](int x, int y, int z) { return Rgb(x == 3 && y == 3 && z == 3 ? 1e6f : 1.0f); };
    const auto steep =
        tests::medium_of(tests::vol_grid({7, 7, 7}, 1, spike), tests::medium_parts(Rgb(0.9f), 1e-2f));
    const Ray beside{Vec3(0.02f, 0.2f, 0.2f), Vec3(1, 0, 0), 0.0f,
                     0.95f};  // thin, below the spike's majorant
    const Vec3d tau = tests::quadrature_depth(*steep, beside, beside.t_max, 20000);
    CHECK(tests::worst_sigmas(tests::spectral_estimates(*steep, beside, 300, 7), tau, Rgb(0.9f), 1e-4) < 5.0);
    const Ray through{Vec3(0.02f, 0.5f, 0.5f), Vec3(1, 0, 0), 0.0f, 0.95f};
    CHECK(steep->transmittance(through, rng, counters).x < 1e-30f);
    CHECK(counters.fallbacks == 0);
}

TEST_CASE("a grid far away or far larger than its rays keeps its optical depth", "[media][heterogeneous]") {
    core::TrackingCounters counters;
    for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const core::Transform place(glm::scale(glm::dmat4(1.0), Vec3d(size)));
        const auto m = tests::medium_of(tests::random_grid({16, 16, 16}, 1, 4),
                                        tests::medium_parts(Rgb(0.5f), float(1.0 / size)), place);
        Ray ray = oblique;
        ray.origin *= float(size), ray.t_max *= float(size);
        const Vec3d tau = m->optical_depth_by_marching(ray, float(1e-4 * size), counters);
        const auto reference =
            tests::medium_of(tests::random_grid({16, 16, 16}, 1, 4), tests::medium_parts(Rgb(0.5f)));
        const Vec3d expected = reference->optical_depth_by_marching(oblique, 1e-4f, counters);
        CHECK(tau.x == Approx(expected.x).epsilon(1e-4));
    }
}

TEST_CASE("albedo may vary over space", "[media][heterogeneous]") {
    auto parts = tests::medium_parts(Rgb(0.0f));
    parts.albedo = std::make_shared<media::GridVolume>(
        tests::vol_grid({2, 1, 1}, 3,
                        [](int x, int, int) { return x ? Rgb(0.2f, 0.4f, 1.0f) : Rgb(1.0f, 0.4f, 0.0f); }),
        core::Transform{}, false, "albedo");
    const auto m =
        tests::medium_of(tests::vol_grid({1, 1, 1}, 1, [](int, int, int) { return Rgb(2.0f); }), parts);
    CHECK(m->coefficients(Vec3(0.1f, 0.5f, 0.5f)).sigma_s.x == Approx(2.0));
    CHECK(m->coefficients(Vec3(0.5f, 0.5f, 0.5f)).sigma_s.x == Approx(1.2));
    CHECK(m->coefficients(Vec3(0.9f, 0.5f, 0.5f)).sigma_s.z == Approx(2.0));
    CHECK(m->traits().scattering);
}
