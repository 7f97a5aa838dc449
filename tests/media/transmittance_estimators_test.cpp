// Every estimator of the transmittance, through real grids: its mean against quadrature, its variance, its
// lookups.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ctime>
#include <iostream>

#include "core/math/warp.h"
#include "media/exp_of_mean.h"
#include "media/vdb_volume.h"
#include "tests/media/test_media.h"
#include "tests/media/vdb_test_files.h"
#include "tests/support/catch.h"
#include "tests/support/test_data.h"

using namespace mote;
using core::Ray, core::Rgb, core::Vec3, core::Vec3d;
using media::TransmittanceEstimator;

namespace {

constexpr std::array estimators = {
    TransmittanceEstimator::ray_marching, TransmittanceEstimator::delta_tracking,
    TransmittanceEstimator::ratio_tracking, TransmittanceEstimator::residual_ratio_tracking,
    TransmittanceEstimator::unbiased_ray_marching};

std::shared_ptr<media::HeterogeneousMedium> medium_with(const std::shared_ptr<const media::VdbGrid>& grid,
                                                        float scale) {
    return media::VdbVolume(grid, {}).make_medium(tests::medium_parts(Rgb(0.8f), scale));
}

/// Rays from a sphere around the medium, through points of the middle half of its box, out on the other side.
std::vector<Ray> rays_through(const core::Bounds3& box, int count) {
    core::Rng rng(11);
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
        const Vec3 from =
            box.center() + box.radius() * core::square_to_sphere({rng.next_float(), rng.next_float()});
        const Vec3 u(rng.next_float(), rng.next_float(), rng.next_float());
        const Vec3 through = box.center() + 0.5f * (u - 0.5f) * box.diagonal();
        rays.push_back({from, glm::normalize(through - from), 0.0f, 2.0f * glm::distance(through, from)});
    }
    return rays;
}

struct Cost {
    double variance = 0.0, lookups = 0.0, nanoseconds = 0.0;  ///< mean over rays, of one estimate
};

/// Means of `trials` estimates a ray against quadrature, 5 standard errors at most; ray marching to its
/// tolerance.
Cost check_estimator(const media::HeterogeneousMedium& m, TransmittanceEstimator estimator,
                     const std::vector<Ray>& rays, const std::vector<double>& tau, int trials) {
    core::Rng rng(5);
    core::TrackingCounters counters;
    Cost cost;
    const double estimates =
        double(rays.size()) * (estimator == TransmittanceEstimator::ray_marching ? 1.0 : double(trials));
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const double expected = std::exp(-tau[i]);
        tests::Mean mean;
        const int n = estimator == TransmittanceEstimator::ray_marching ? 1 : trials;
        const std::clock_t start = std::clock();
        for (int k = 0; k < n; ++k) mean.add(m.transmittance_by(estimator, rays[i], rng, counters).x);
        cost.nanoseconds += 1e9 * double(std::clock() - start) / CLOCKS_PER_SEC / estimates;
        INFO(media::name_of(estimator) << ": ray " << i << ", " << mean.value() << " against " << expected);
        if (n == 1) {
            CHECK(std::fabs(mean.value() / expected - 1.0) < 2e-3 * tau[i] + 1e-5);
        } else {
            // Where no trial met anything the spread says nothing; a share of 1 / trials may have been
            // missed.
            CHECK((mean.sigmas_from(expected, 1e-5) < 5.0 ||
                   (mean.standard_error() == 0.0 && std::fabs(mean.value() - expected) < 10.0 / trials)));
        }
        cost.variance += mean.standard_error() * mean.standard_error() * n / double(rays.size());
    }
    cost.lookups = double(counters.lookups) / estimates;
    return cost;
}

using GridCosts = std::array<Cost, estimators.size()>;

GridCosts costs_of(const std::string& path, const std::string& grid_name, double optical_depth) {
    const auto grid = media::load_vdb_grid(path, grid_name);
    const auto probe = medium_with(grid, 1.0f);
    const auto rays = rays_through(probe->bounds(), 24);
    core::TrackingCounters counters;
    std::vector<double> tau;
    double largest = 0.0;
    for (const Ray& ray : rays) {
        tau.push_back(probe->optical_depth_by_marching(ray, ray.t_max / 20000.0f, counters).x);
        largest = std::max(largest, tau.back());
    }
    const auto scale = float(optical_depth / largest);
    for (double& t : tau) t *= double(scale);
    GridCosts costs;
    const auto medium = medium_with(grid, scale);
    for (std::size_t e = 0; e < estimators.size(); ++e)
        costs[e] = check_estimator(*medium, estimators[e], rays, tau, 4000);
    std::cout << fmt::format("{} up to optical depth {}, {}: variance, lookups and ns of one estimate\n",
                             grid->name(), optical_depth, probe->traits().estimator_reason);
    for (std::size_t e = 0; e < estimators.size(); ++e)
        std::cout << fmt::format("  {:24} {:8.5f} {:8.2f} {:8.0f}\n", media::name_of(estimators[e]),
                                 costs[e].variance, costs[e].lookups, costs[e].nanoseconds);
    return costs;
}

}  // namespace

TEST_CASE("every estimator of the transmittance agrees with quadrature on a real smoke",
          "[media][estimators]") {
    const auto path = tests::test_data("vdb/openusd/smoke_000002.vdb");
    if (!path) return;
    const GridCosts costs = costs_of(*path, "density", 4.0);
    // Ratio tracking is never noisier than delta tracking, and residual tracking never noisier than that.
    CHECK(costs[2].variance < costs[1].variance);
    CHECK(costs[3].variance < 1.02 * costs[2].variance);
    CHECK(costs[4].variance < 0.2 * costs[3].variance);
}

TEST_CASE("estimators agree on grids of tiles and of one smooth lump", "[media][estimators]") {
    const tests::GridFolder folder;
    for (const char* kind : {"tiles", "lump"}) {
        INFO(kind);
        const GridCosts costs = costs_of(folder.grid(kind), "density", 3.0);
        CHECK(costs[3].variance < 1.02 * costs[2].variance);
    }
}

TEST_CASE("the exponential of a mean is right in the mean, whatever the spread of what it is of",
          "[media][estimators][planted]") {
    for (const double spread : {0.01, 0.3, 1.0}) {
        core::Rng rng(7);
        tests::Mean right, without_series;
        for (int i = 0; i < 400000; ++i) {
            media::MeanEstimates<double> x{};
            const std::size_t count = media::sample_estimates(rng);
            for (std::size_t k = 0; k < count; ++k)
                x[k] = -1.2 + spread * (2.0 * double(rng.next_float()) - 1.0);
            right.add(media::exp_of_mean(x, count));
            without_series.add(std::exp(x[0]));
        }
        INFO("spread " << spread << ": " << right.value() << " against " << std::exp(-1.2));
        CHECK(right.sigmas_from(std::exp(-1.2), 1e-7) < 4.0);
        if (spread >= 0.3) CHECK(without_series.sigmas_from(std::exp(-1.2), 1e-7) > 5.0);
    }
}

TEST_CASE("unbiased ray marching looks up the same in a copy of the grid", "[media][estimators]") {
    const tests::GridFolder folder;
    const auto grid = media::load_vdb_grid(folder.grid("lump"));
    const auto plain = medium_with(grid, 0.2f);
    auto parts = tests::medium_parts(Rgb(0.8f), 0.2f);
    parts.tracking.transmittance = TransmittanceEstimator::unbiased_ray_marching;
    const auto copied = media::VdbVolume(grid, {}).make_medium(parts);
    REQUIRE(copied->traits().estimator == "unbiased_ray_marching");
    core::Rng a(3), b(3);
    core::TrackingCounters counters;
    for (const Ray& ray : rays_through(plain->bounds(), 200)) {
        const float t =
            plain->transmittance_by(TransmittanceEstimator::unbiased_ray_marching, ray, a, counters).x;
        CHECK(std::fabs(copied->transmittance(ray, b, counters).x - t) < 1e-4f);
    }
}

TEST_CASE("ray marching keeps its tolerance", "[media][estimators]") {
    const tests::GridFolder folder;
    const auto grid = media::load_vdb_grid(folder.grid("lump"));
    const auto probe = medium_with(grid, 1.0f);
    const auto rays = rays_through(probe->bounds(), 24);
    for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5}) {
        auto parts = tests::medium_parts(Rgb(0.8f), 0.02f);  // thin: the optical depth is read off well
        parts.tracking.marching_tolerance = tolerance;
        const auto medium = media::VdbVolume(grid, {}).make_medium(parts);
        core::Rng rng(1);
        core::TrackingCounters marching, counters;
        double worst = 0.0;
        for (const Ray& ray : rays) {
            const double exact = medium->optical_depth_by_marching(ray, ray.t_max / 200000.0f, counters).x;
            const double t = medium->transmittance_by(estimators[0], ray, rng, marching).x;
            if (exact > 0.05) worst = std::max(worst, std::fabs(-std::log(t) / exact - 1.0));
        }
        std::cout << fmt::format("marching to {:g}: {:.2g} off at most, {:.0f} lookups\n", tolerance, worst,
                                 double(marching.lookups) / double(rays.size()));
        CHECK(worst < 3.0 * tolerance);  // it aims at the tolerance, by how much the last refinement moved
    }
}

TEST_CASE("a wrong estimator of the transmittance is caught", "[media][estimators][planted]") {
    const tests::GridFolder folder;
    const auto grid = media::load_vdb_grid(folder.grid("lump"));
    auto parts = tests::medium_parts(Rgb(0.8f), 0.5f);
    const auto right = media::VdbVolume(grid, {}).make_medium(parts);
    parts.plant_majorant_factor = 0.3f;  // interpolated densities exceed their bound
    const auto wrong = media::VdbVolume(grid, {}).make_medium(parts);
    const auto rays = rays_through(right->bounds(), 8);
    for (const auto estimator : {estimators[1], estimators[2], estimators[3]}) {
        double worst_right = 0.0, worst_wrong = 0.0;
        for (const Ray& ray : rays) {
            core::TrackingCounters counters;
            const double expected =
                std::exp(-right->optical_depth_by_marching(ray, ray.t_max / 20000.0f, counters).x);
            core::Rng rng(3);
            tests::Mean a, b;
            for (int i = 0; i < 20000; ++i) {
                a.add(right->transmittance_by(estimator, ray, rng, counters).x);
                b.add(wrong->transmittance_by(estimator, ray, rng, counters).x);
            }
            if (a.standard_error() == 0.0) continue;
            worst_right = std::max(worst_right, a.sigmas_from(expected, 1e-5));
            worst_wrong = std::max(worst_wrong, b.sigmas_from(expected, 1e-5));
        }
        INFO(media::name_of(estimator));
        CHECK(worst_right < 5.0);
        CHECK(worst_wrong > 5.0);
    }
}

TEST_CASE("the automatic estimator is unbiased marching, but where all cells are constant",
          "[media][estimators]") {
    const tests::GridFolder folder;
    for (const char* kind : {"tiles", "lump", "single"}) {
        const auto medium = medium_with(media::load_vdb_grid(folder.grid(kind)), 1.0f);
        CHECK(medium->estimator() == TransmittanceEstimator::unbiased_ray_marching);
        CHECK(medium->traits().estimator == "unbiased_ray_marching");
    }
    const auto constant = media::ConstantVolume(Rgb(2.0f)).make_medium(tests::medium_parts(Rgb(0.8f)));
    CHECK(constant->estimator() == TransmittanceEstimator::residual_ratio_tracking);
}
