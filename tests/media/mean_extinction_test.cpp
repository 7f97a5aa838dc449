// The mean extinction within a radius, against averages over many points of the ball.
#include "media/mean_extinction.h"

#include <cmath>
#include <iostream>

#include "core/math/warp.h"
#include "media/homogeneous_medium.h"
#include "tests/media/test_media.h"
#include "tests/support/catch.h"

using namespace mote;
using core::Bounds3, core::Rgb, core::Vec3;
using media::MeanExtinction;

namespace {

/// Smooth puffs in a grid of n^3 voxels that fills [0, n]^3 of the world.
std::shared_ptr<media::HeterogeneousMedium> puffs(int n, int channels = 1) {
    const auto value = [](int x, int y, int z) {
        const float a = 0.6f + 0.4f * std::sin(0.5f * float(x)) * std::cos(0.4f * float(y) + 0.3f * float(z));
        return a * Rgb(1.0f, 0.1f, 3.0f);
    };
    return tests::medium_of(tests::vol_grid(glm::ivec3(n), channels, value), tests::medium_parts(Rgb(0.5f)),
                            core::Transform(glm::scale(glm::dmat4(1.0), glm::dvec3(n))));
}

/// Mean of sigma_t over the ball, by many points.
Rgb mean_by_points(const core::Medium& m, const Bounds3& box, const Vec3& p, float radius) {
    core::Rng rng(1);
    Rgb sum(0.0f);
    const int count = 40000;
    for (int i = 0; i < count; ++i) {
        const Vec3 q = p + radius * std::cbrt(rng.next_float()) *
                               core::square_to_sphere({rng.next_float(), rng.next_float()});
        if (box.contains(q)) sum += m.coefficients(q).sigma_t;
    }
    return sum / float(count);
}

}  // namespace

TEST_CASE("the mean extinction is that of the ball, at every radius", "[media][mean_extinction]") {
    for (const int channels : {1, 3}) {
        const auto medium = puffs(24, channels);
        const Bounds3 box{Vec3(0.0f), Vec3(24.0f)};
        const MeanExtinction means(*medium, box);
        CHECK(means.cell_size() == Approx(1.0f));
        double worst = 0.0, squares = 0.0;
        int count = 0;
        core::Rng rng(2);
        for (const float radius : {0.05f, 0.4f, 1.0f, 2.5f, 6.0f, 12.0f, 100.0f}) {
            // A ball about as large as the box, partly outside: cells represent it badly.
            const bool half_of_the_box = radius == 12.0f;
            double here = 0.0;
            for (int i = 0; i < 12; ++i) {
                const Vec3 p = 4.0f + 16.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float());
                const Rgb mean = means.mean(p, radius), expected = mean_by_points(*medium, box, p, radius);
                for (int c = 0; c < 3; ++c) {
                    const double error = mean[c] / expected[c] - 1.0;
                    INFO("radius " << radius << " channel " << c << ": " << mean[c] << " against "
                                   << expected[c]);
                    CHECK(std::fabs(error) < (half_of_the_box ? 0.6 : 0.25));
                    here += error * error / 36.0;
                    if (half_of_the_box) continue;
                    worst = std::max(worst, std::fabs(error)), squares += error * error, ++count;
                }
            }
            std::cout << "mean extinction, " << channels << " channels, radius of " << radius
                      << " voxels: rms error " << 100.0 * std::sqrt(here) << " %\n";
        }
        INFO("worst " << worst << ", rms " << std::sqrt(squares / count));
        CHECK(std::sqrt(squares / count) < 0.06);  // cubes of cells represent a ball
    }
}

TEST_CASE("the mean extinction of a radius of zero is the extinction itself", "[media][mean_extinction]") {
    const auto medium = puffs(16);
    const MeanExtinction means(*medium, {Vec3(0.0f), Vec3(16.0f)});
    for (const Vec3& p : {Vec3(3.3f, 4.4f, 5.5f), Vec3(8.0f), Vec3(15.9f, 0.1f, 7.0f)}) {
        const float exact = medium->coefficients(p).sigma_t.x;
        CHECK(means.mean(p, 0.0f).x == exact);
        // It is reached smoothly: no step between a small radius and none.
        CHECK(means.mean(p, 1e-3f).x == Approx(exact).epsilon(1e-4));
    }
}

TEST_CASE("the mean extinction moves smoothly with the radius, and vanishes far away",
          "[media][mean_extinction]") {
    const auto medium = puffs(16);
    const MeanExtinction means(*medium, {Vec3(0.0f), Vec3(16.0f)});
    const Vec3 p(5.0f, 6.0f, 9.0f);
    float before = means.mean(p, 0.01f).x;
    for (float radius = 0.01f; radius < 1e4f; radius *= 1.02f) {
        const float now = means.mean(p, radius).x;
        REQUIRE(std::fabs(now - before) < 0.06f);
        REQUIRE(now >= 0.0f);
        before = now;
    }
    CHECK(before < 1e-6f);  // a ball of 10 km holds next to nothing
    CHECK(means.mean(Vec3(1000.0f), 1.0f).x == 0.0f);
}

TEST_CASE("memory of the mean extinction stays within its bound", "[media][mean_extinction]") {
    const auto medium = puffs(32, 3);
    const Bounds3 box{Vec3(0.0f), Vec3(32.0f)};
    for (const std::size_t bytes :
         {std::size_t(1), std::size_t(4000), std::size_t(100000), std::size_t(1) << 20}) {
        const MeanExtinction means(*medium, box, bytes);
        INFO(bytes << " bytes allowed, " << means.memory_bytes() << " used");
        CHECK(means.memory_bytes() <= std::max<std::size_t>(bytes, 64));
        // Means of large regions do not depend on the memory.
        CHECK(means.mean(Vec3(16.0f), 100.0f).x ==
              Approx(MeanExtinction(*medium, box).mean(Vec3(16.0f), 100.0f).x).epsilon(0.05));
    }
    const media::HomogeneousMedium fog(Rgb(1, 2, 3), Rgb(0.0f), Rgb(0.0f),
                                       std::make_shared<media::IsotropicPhase>());
    const MeanExtinction constant(fog, box);
    CHECK(constant.memory_bytes() == 0);
    CHECK(constant.mean(Vec3(1e6f), 5.0f) == Rgb(1, 2, 3));
}
