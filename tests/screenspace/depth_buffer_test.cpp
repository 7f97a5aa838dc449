// Epipolar sampling over a host's depth buffer: what its functions and numbers must be.
#include "screenspace/epipolar/depth_buffer.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "screenspace/in_scattering/airlight.h"
#include "tests/support/catch.h"

using namespace mote::core;
using namespace mote::screenspace;

TEST_CASE("A march that is not finite is refused, and one that is counted", "[epipolar]") {
    const std::vector<float> depth(64, 4.0f);
    const DepthBuffer buffer{8, 8, depth, 10.0, 8.0, {4.0, 4.0}, {0.3, 0.2, 2.0}};
    const LineSampling sampling{.initial = 4};
    // The angle at the lamp over its distance from the ray, by which light is divided before it is
    // interpolated.
    const auto angle = [&](const Vec2d& film, double distance) {
        const Ray ray{Vec3(0.0f), glm::normalize(Vec3(film.x - 4.0, film.y - 4.0, 8.0))};
        const PassingRay passing(ray, Vec3(buffer.lamp));
        return Rgb(float((passing.angle(distance) - passing.angle(0.0)) / passing.distance));
    };
    const auto even = light_over(buffer, 16, sampling, angle);
    REQUIRE(even.light.size() == 64);
    for (int i = 0; i < 64; ++i) {
        const Vec2d film{i % 8 + 0.5, i / 8 + 0.5};
        const double z = 8.0 / std::hypot(film.x - 4.0, film.y - 4.0, 8.0);
        CHECK(even.light[std::size_t(i)].x == Approx(angle(film, 4.0 / z).x));
    }
    CHECK(even.marched > 0);
    const auto march = [](const Vec2d& film, double) {
        return film.x > 6.0 ? Rgb(std::numeric_limits<float>::quiet_NaN()) : Rgb(0.25f);
    };
    CHECK_THROWS_AS(light_over(buffer, 16, sampling, march), std::invalid_argument);
}
