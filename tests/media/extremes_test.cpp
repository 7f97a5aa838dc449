// Grids at the extremes: every estimator of the transmittance, from vacuum to lead, over density steps of a
// million to one, under any placing, along boundaries, and beyond the step limit. docs/methods/media.md has
// the table of what was tried and where it is tested.
#include <array>
#include <cmath>
#include <ctime>
#include <iostream>

#include "media/mean_extinction.h"
#include "media/vdb_volume.h"
#include "tests/media/test_media.h"
#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"

using namespace mote;
using core::PathWeights, core::Ray, core::Rgb, core::Transform, core::Vec3, core::Vec3d;
using media::TransmittanceEstimator;

namespace {

constexpr std::array estimators = {
    TransmittanceEstimator::ray_marching, TransmittanceEstimator::delta_tracking,
    TransmittanceEstimator::ratio_tracking, TransmittanceEstimator::residual_ratio_tracking,
    TransmittanceEstimator::automatic};

/// Oblique through the unit cube, from within it to within it.
const Ray oblique{Vec3(0.05f, 0.1f, 0.15f), glm::normalize(Vec3(0.8f, 0.7f, 0.6f)), 0.0f, 1.05f};

/// `loose` above 1: majorants that many times too high.
media::MediumParts parts_with(float scale, float loose = 1.0f) {
    auto parts = tests::medium_parts(Rgb(0.9f), scale);
    parts.plant_majorant_factor = loose;
    return parts;
}

/// Is the mean of `trials` estimates within 5 standard errors of exp(-tau)? An estimate between 0 and 1 has a
/// variance of at most T (1 - T); what is rarer than one in `trials` shows up a few times at most (the
/// constant). Ray marching: to its tolerance of 1e-3 of the optical depth.
bool agrees(const media::HeterogeneousMedium& m, TransmittanceEstimator estimator, const Ray& ray, double tau,
            int trials, core::TrackingCounters& counters) {
    const double expected = std::exp(-tau);
    core::Rng rng(3);
    if (estimator == TransmittanceEstimator::ray_marching) {
        const double t = m.transmittance_by(estimator, ray, rng, counters).x;
        return expected > 1.2e-38 ? std::fabs(std::log(t) + tau) <= 1e-3 * tau + 1e-6 : t <= 1.2e-38;
    }
    tests::Mean mean;
    bool in_range = true;
    for (int i = 0; i < trials; ++i) {
        const float t = m.transmittance_by(estimator, ray, rng, counters).x;
        // Marching's series may leave the range by a little, tracking never does.
        const float beyond = m.estimator() == TransmittanceEstimator::unbiased_ray_marching &&
                                     estimator == TransmittanceEstimator::automatic
                                 ? 0.5f
                                 : 0.0f;
        in_range &= t >= -beyond && t <= 1.0f + beyond;
        mean.add(t);
    }
    const double spread = std::sqrt(expected * -std::expm1(-tau) / trials);
    return in_range && std::fabs(mean.value() - expected) < 5.0 * spread + 10.0 / trials + 1e-7;
}

int trials_for(double tau) { return tau < 0.5 ? 50000 : tau < 50.0 ? 20000 : 200; }

/// Wavy, nowhere zero: 0.2 to 1.8.
media::VolFile waves() {
    return tests::vol_grid(glm::ivec3(16), 1, [](int x, int y, int z) {
        return Rgb(1.0f + 0.8f * std::sin(0.9f * float(x)) * std::cos(0.7f * float(y) + 0.5f * float(z)));
    });
}

media::VolFile constant_file() {
    return tests::vol_grid(glm::ivec3(9), 1, [](int, int, int) { return Rgb(1.0f); });
}

double depth_of(const media::VolFile& file, const Ray& ray) {
    const auto m = tests::medium_of(file, tests::medium_parts(Rgb(0.9f)));
    return tests::quadrature_depth(*m, ray, ray.t_max, 40000).x;
}

/// Thin on the left, `ratio` times as dense on the right.
media::VolFile step_of(float thin, float dense) {
    return tests::vol_grid(glm::ivec3(16, 4, 4), 1,
                           [=](int x, int, int) { return Rgb(x < 8 ? thin : dense); });
}
const Ray through_thin{Vec3(0.01f, 0.5f, 0.5f), Vec3(1, 0, 0), 0.0f, 0.4f};

}  // namespace

TEST_CASE("every estimator from optical depth 1e-6 to 1e6", "[media][extremes]") {
    for (const media::VolFile& file : {constant_file(), waves(), tests::random_grid(glm::ivec3(12), 1, 5)}) {
        const double unit = depth_of(file, oblique);
        for (const float loose : {1.0f, 3.0f})
            for (double tau = 1e-6; tau < 2e6; tau *= 10.0) {
                const auto m = tests::medium_of(file, parts_with(float(tau / unit), loose));
                for (const auto estimator : estimators) {
                    INFO(media::name_of(estimator)
                         << ", optical depth " << tau << ", majorants " << loose << " times too high");
                    core::TrackingCounters counters;
                    CHECK(agrees(*m, estimator, oblique, tau, trials_for(tau), counters));
                    CHECK(counters.fallbacks == 0);
                }
            }
    }
}

TEST_CASE("what is deterministic is exact from optical depth 1e-6 to 1e6", "[media][extremes]") {
    core::Rng rng(1);
    core::TrackingCounters counters;
    for (double tau = 1e-6; tau < 2e6; tau *= 10.0) {
        const auto scale = float(tau / double(oblique.t_max));
        const auto grid = tests::medium_of(constant_file(), parts_with(scale));
        const auto unbounded = media::ConstantVolume(Rgb(1.0f)).make_medium(parts_with(scale));
        for (const auto& m : {grid, unbounded})
            for (const auto estimator :
                 {TransmittanceEstimator::ray_marching, TransmittanceEstimator::residual_ratio_tracking,
                  TransmittanceEstimator::automatic}) {
                const double exact = std::exp(-double(scale) * double(oblique.t_max));
                const double t = m->transmittance_by(estimator, oblique, rng, counters).x;
                INFO(media::name_of(estimator) << ", optical depth " << tau << ": " << t);
                CHECK((exact > 1.2e-38 ? std::fabs(t - exact) < 1e-5 * exact : t <= 1.2e-38));
            }
    }
    CHECK(counters.lookups == 0);
}

TEST_CASE("an optical depth that is wrong by seven per cent is caught", "[media][extremes][planted]") {
    const media::VolFile file = waves();
    const auto m = tests::medium_of(file, parts_with(float(1.0 / depth_of(file, oblique))));
    core::TrackingCounters counters;
    for (const auto estimator : estimators) {
        INFO(media::name_of(estimator));
        CHECK_FALSE(agrees(*m, estimator, oblique, 1.07, trials_for(1.0), counters));
        CHECK_FALSE(agrees(*m, estimator, oblique, 0.93, trials_for(1.0), counters));
    }
}

TEST_CASE("a checkerboard of 0 and 10,000", "[media][extremes]") {
    const auto board = tests::vol_grid(
        glm::ivec3(16), 1, [](int x, int y, int z) { return Rgb((x + y + z) % 2 ? 1e4f : 0.0f); });
    // Along a row of voxel centres the density is a triangle wave between 0 and 1e4.
    const float half = 0.5f / 16.0f;
    const Ray row{Vec3(half, half, half), Vec3(1, 0, 0), 0.0f, 14.0f / 16.0f};
    for (const double tau : {1e-3, 1.0, 1e4}) {
        for (const Ray& ray : {row, oblique}) {
            const double unit = &ray == &row ? 5e3 * double(row.t_max) : depth_of(board, ray);
            const auto m = tests::medium_of(board, parts_with(float(tau / unit)));
            for (const auto estimator : estimators) {
                core::TrackingCounters counters;
                INFO(media::name_of(estimator) << ", optical depth " << tau);
                CHECK(agrees(*m, estimator, ray, tau, trials_for(tau), counters));
                CHECK(counters.fallbacks == 0);
            }
        }
    }
}

TEST_CASE("past a density a million times larger", "[media][extremes]") {
    const media::VolFile file = step_of(1.0f, 1e6f);
    const double tau = double(through_thin.t_max);
    const auto m = tests::medium_of(file, parts_with(1.0f));
    for (const auto estimator : estimators) {
        constexpr int trials = 20000;
        core::TrackingCounters counters;
        INFO(media::name_of(estimator));
        CHECK(agrees(*m, estimator, through_thin, tau, trials, counters));
        CHECK(counters.fallbacks == 0);
        if (estimator == TransmittanceEstimator::ray_marching) continue;
        CHECK(counters.lookups < 5u * std::uint64_t(trials));
    }
}

TEST_CASE("one voxel of up to 1e37 among 0.1 costs what the ray crosses", "[media][extremes][regular]") {
    const int trials = 2000;
    for (const float hot : {1e3f, 1e5f, 1e6f, 1e20f, 1e37f}) {
        const auto m = tests::medium_of(tests::hot_grid(1, hot), parts_with(1.0f));
        // Past the cells' dense voxels, through the same cells; and into one of these voxels.
        const Ray beside{Vec3(0.01f, 0.65f, 0.65f), Vec3(1, 0, 0), 0.0f, 0.98f};
        const Ray into{Vec3(0.01f, 8.5f / 16.0f, 8.5f / 16.0f), Vec3(1, 0, 0), 0.0f, 0.98f};
        for (const auto estimator : estimators) {
            INFO(media::name_of(estimator) << " past a voxel of " << hot);
            core::TrackingCounters counters;
            CHECK(agrees(*m, estimator, beside, 0.1 * double(beside.t_max), trials, counters));
            if (hot > 1e4f) CHECK(agrees(*m, estimator, into, 1e3, trials, counters));
            CHECK(counters.fallbacks == 0);
            // 16 voxels to a ray, at most four lookups each, or as many tentative collisions before a cell is
            // dense enough for that.
            CHECK(counters.lookups < 2u * 300u * std::uint64_t(trials));
        }
        core::Rng rng(1);
        core::TrackingCounters counters;
        for (int i = 0; i < trials; ++i)
            for (const Ray& ray : {beside, into}) {
                core::PathWeights weights;
                Rgb emitted(0.0f);
                m->sample_collision(ray, weights, emitted, rng, counters);
                m->connect(ray, weights, rng, counters);
                REQUIRE((core::is_finite(weights.throughput) && core::is_finite(weights.unidirectional)));
            }
        CHECK(counters.fallbacks == 0);
        CHECK(counters.lookups < 4u * 300u * std::uint64_t(trials));
    }
}

TEST_CASE("regular tracking keeps every mean: grey, in colours, and with emission",
          "[media][extremes][regular]") {
    const Rgb glow(1.0f, 2.0f, 3.0f);
    for (const int channels : {1, 3})
        for (const float albedo : {0.0f, 0.8f}) {
            auto parts = tests::medium_parts(Rgb(albedo));
            parts.emission.radiance = std::make_shared<media::ConstantVolume>(glow);
            const auto m = tests::medium_of(tests::hot_grid(channels, 1e4f), parts);
            const Vec3d tau = tests::quadrature_depth(*m, tests::past_hot, tests::past_hot.t_max, 40000);
            const auto e = tests::spectral_estimates(*m, tests::past_hot, 100000, 9);
            INFO(channels << " channels, albedo " << albedo << ", optical depth " << tau.x << " " << tau.y);
            if (albedo > 0.0f) {
                CHECK(tests::worst_sigmas(e, tau, Rgb(albedo), 1e-4) < 4.5);
                CHECK(tests::worst_sigmas(e, 1.05 * tau, Rgb(albedo), 1e-4) > 4.5);
            }
            for (int c = 0; c < 3; ++c) {
                const double exact = (1.0 - double(albedo)) * double(glow[c]) * -std::expm1(-tau[c]);
                CHECK(e.emitted[std::size_t(c)].sigmas_from(exact, 1e-4) < 4.5);
                CHECK(e.emitted[std::size_t(c)].sigmas_from(1.05 * exact, 1e-4) > 4.5);
            }
        }
}

TEST_CASE("marching, fractions of the way and mean extinction stay finite beside 1e37",
          "[media][extremes][regular]") {
    for (const int channels : {1, 3}) {
        const auto m = tests::medium_of(tests::hot_grid(channels, 1e37f), parts_with(1.0f));
        core::TrackingCounters counters;
        std::array<Vec3d, 8> depths;
        m->optical_depths_along(tests::past_hot, 1.0f / 16.0f, depths, counters);
        for (const Vec3d& d : depths) CHECK((std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z)));
        CHECK(std::is_sorted(depths.begin(), depths.end(), [](auto& a, auto& b) { return a.x < b.x; }));
    }
    for (const float hot : {1e37f, 3e38f}) {
        const auto m = tests::medium_of(tests::hot_grid(1, hot), parts_with(1.0f));
        const media::MeanExtinction mean(*m, m->bounds());
        for (const float radius : {0.0f, 0.03f, 0.2f, 10.0f}) {
            INFO(hot << ", radius " << radius);
            CHECK(core::is_finite(mean.mean(Vec3(3.5f, 8.5f, 8.5f) / 16.0f, radius)));
            if (radius < 1.0f) CHECK(mean.mean(Vec3(3.5f, 8.5f, 8.5f) / 16.0f, radius).x > 1e-6f * hot);
            if (radius < 0.1f) CHECK(mean.mean(Vec3(0.9f), radius).x == Approx(0.1f).epsilon(0.01));
        }
    }
}

TEST_CASE("a hopeless majorant ends within a second, and is counted", "[media][extremes][step_limit]") {
    // Nothing along the ray, in a cell with a majorant of optical depth 4e8: no event would ever end the
    // walk.
    const auto step =
        tests::vol_grid(glm::ivec3(16, 4, 4), 1, [](int x, int, int) { return Rgb(x < 7 ? 0.0f : 1e6f); });
    const auto m = tests::medium_of(step, parts_with(1e3f, 1.5f));
    Ray through_nothing = through_thin;
    through_nothing.t_max = 0.3f;
    core::Rng rng(1);
    core::TrackingCounters counters;
    const std::clock_t start = std::clock();
    CHECK(m->transmittance_by(TransmittanceEstimator::ratio_tracking, through_nothing, rng, counters) ==
          Rgb(1.0f));
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;
    std::cout << "a walk of " << counters.lookups << " lookups took " << seconds << " s\n";
    CHECK(seconds < 10.0);  // below one; more under sanitizers
    CHECK(counters.fallbacks == 1);
}

TEST_CASE("beyond the step limit estimates keep their mean", "[media][extremes][step_limit]") {
    const media::VolFile file = tests::random_grid(glm::ivec3(12), 1, 5);
    const double unit = depth_of(file, oblique);
    for (const double tau : {0.5, 2.0})
        for (const std::uint64_t limit : {1u, 3u}) {
            auto parts = parts_with(float(tau / unit), 4.0f);
            parts.step_limit = limit;
            const auto m = tests::medium_of(file, parts);
            for (const auto estimator : estimators) {
                if (estimator == TransmittanceEstimator::ray_marching ||
                    estimator == TransmittanceEstimator::automatic)
                    continue;  // neither walks from collision to collision
                core::TrackingCounters counters;
                INFO(media::name_of(estimator) << ", depth " << tau << ", at most " << limit << " steps");
                CHECK(agrees(*m, estimator, oblique, tau, 4000, counters));
                CHECK_FALSE(agrees(*m, estimator, oblique, 1.2 * tau, 4000, counters));
                CHECK(counters.fallbacks > 400);
            }
            // Connections and passed paths: the same; a path that was given up is lost, not passed on.
            const auto e = tests::spectral_estimates(*m, oblique, 4000, 4);
            CHECK(e.connection[0].sigmas_from(std::exp(-tau), 1e-3) < 5.0);
            CHECK(e.transmittance[0].sigmas_from(std::exp(-tau), 1e-3) < 5.0);
            CHECK(e.escape[0].value() < std::exp(-tau));
        }
}

TEST_CASE("a channel without extinction passes an infinite length", "[media][extremes]") {
    auto parts = parts_with(1.0f);
    parts.step_limit = 1000;
    const auto m = media::ConstantVolume(Rgb(0.0f, 1.0f, 2.0f)).make_medium(parts);
    const Ray endless{Vec3(0.0f), Vec3(0, 0, 1), 0.0f, core::infinity};
    for (const auto estimator : estimators) {
        core::Rng rng(1);
        core::TrackingCounters counters;
        INFO(media::name_of(estimator));
        CHECK(m->transmittance_by(estimator, endless, rng, counters) == Rgb(1.0f, 0.0f, 0.0f));
    }
}

TEST_CASE("every estimator under rotation, shear, anisotropic voxels of 1e-4 to 1e4", "[media][extremes]") {
    const media::VolFile file = waves();
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.6, shear[2][1] = -0.3;
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(Vec3d(1, 2, 3))) * shear *
                              glm::scale(glm::dmat4(1.0), Vec3d(1.0, 0.1, 4.0));
    const double tau = 1.5, unit = depth_of(file, oblique) / double(oblique.t_max);
    for (const double voxel : {1e-4, 1.0, 1e4}) {
        const Transform place(glm::scale(glm::dmat4(1.0), Vec3d(16.0 * voxel)) * turned);
        const Vec3 from(place.point(Vec3d(oblique.origin)));
        const Vec3 to(place.point(Vec3d(oblique.at(oblique.t_max))));
        const Ray ray{from, glm::normalize(to - from), 0.0f, glm::distance(from, to)};
        const auto scale = float(tau / unit / double(ray.t_max));
        const auto m = tests::medium_of(file, parts_with(scale), place);
        for (const auto estimator : estimators) {
            core::TrackingCounters counters;
            INFO(media::name_of(estimator) << ", voxels of " << voxel);
            CHECK(agrees(*m, estimator, ray, tau, 40000, counters));
        }
    }
}

TEST_CASE("rays that start on, end on, or graze the boundary of a grid", "[media][extremes]") {
    const tests::GridFolder folder;
    const auto grid = media::load_vdb_grid(folder.grid("tiles"));  // 0.75 from voxel -4 to 35, vacuum beyond
    const auto m = media::VdbVolume(grid).make_medium(parts_with(0.1f));
    const float a = -5.0f, b = 36.0f, middle = 15.0f;  // where the interpolation reaches zero
    const float diagonal = 1.0f / std::sqrt(2.0f);
    struct Case {
        const char* name;
        Ray ray;
        double depth;
    };
    const std::array<Case, 11> cases = {{
        {"starts on a face", {Vec3(a, middle, middle), Vec3(1, 0, 0), 0.0f, 100.0f}, 3.0},
        {"ends on a face", {Vec3(-20, middle, middle), Vec3(1, 0, 0), 0.0f, 56.0f}, 3.0},
        {"face to face", {Vec3(middle, a, middle), Vec3(0, 1, 0), 0.0f, b - a}, 3.0},
        {"leaves from a face", {Vec3(a, middle, middle), Vec3(-1, 0, 0), 0.0f, 100.0f}, 0.0},
        {"arrives at a face", {Vec3(-20, middle, middle), Vec3(1, 0, 0), 0.0f, 15.0f}, 0.0},
        {"lies in a face", {Vec3(-20, a, middle), Vec3(1, 0, 0), 0.0f, 100.0f}, 0.0},
        {"lies in the far face", {Vec3(-20, middle, b), Vec3(1, 0, 0), 0.0f, 100.0f}, 0.0},
        {"runs along an edge", {Vec3(a, a, -50), Vec3(0, 0, 1), 0.0f, core::infinity}, 0.0},
        {"touches an edge", {Vec3(-15, 5, middle), Vec3(diagonal, -diagonal, 0), 0.0f, 100.0f}, 0.0},
        {"without length", {Vec3(middle), Vec3(1, 0, 0), 2.0f, 2.0f}, 0.0},
        {"along a cell's face", {Vec3(3, -20, 7), Vec3(0, 1, 0), 0.0f, core::infinity}, 3.0},
    }};
    for (const Case& c : cases)
        for (const auto estimator : estimators) {
            core::TrackingCounters counters;
            INFO(c.name << ", " << media::name_of(estimator));
            CHECK(agrees(*m, estimator, c.ray, c.depth, 20000, counters));
        }
}

TEST_CASE("albedo 0 absorbs, albedo 1 does not", "[media][extremes]") {
    for (const float albedo : {0.0f, 1.0f}) {
        auto parts = parts_with(1e3f);
        parts.albedo = std::make_shared<media::ConstantVolume>(Rgb(albedo));
        const auto m = tests::medium_of(waves(), parts);
        CHECK(m->traits().scattering == (albedo > 0.0f));
        core::Rng rng(1);
        core::TrackingCounters counters;
        for (int i = 0; i < 1000; ++i) {
            PathWeights w;
            w.light = Rgb(1.0f);  // as after a scattering of density 1
            Rgb emitted(0.0f);
            // A medium that only absorbs has no collisions, and no throughput remains.
            const bool collided = m->sample_collision(oblique, w, emitted, rng, counters).has_value();
            REQUIRE(collided == (albedo > 0.0f));
            REQUIRE(w.throughput == Rgb(albedo));
            REQUIRE(core::is_finite(w.unidirectional));
            REQUIRE(core::is_finite(w.light));
        }
    }
}
