// Points on surfaces: how even they are, and that each has the same area.
#include <complex>

#include "core/math/random.h"
#include "core/objects/error.h"
#include "gathering/surface_points/surfels.h"
#include "tests/gathering/bundle_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::TriangleBuilder;

namespace {

SurfaceTriangles plate() { return TriangleBuilder().quad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}).list(); }

/// Smallest distance of two points that face the same way, in that of the hexagonal packing.
double distance_ratio(const Surfels& s) {
    double least = 1e30;
    for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (glm::dot(s.normals[i], s.normals[j]) > 0.0f)
                least = std::min(least, double(glm::length(s.positions[i] - s.positions[j])));
    return least / std::sqrt(2.0 / std::sqrt(3.0) * s.patch());
}

/// Mean power of the points on the plate over frequencies from `from` to `to`, in units of the root of their
/// number: 1 for independent points.
double power(const Surfels& s, double from, double to) {
    const double root = std::sqrt(double(s.size()));
    const int largest = int(to * root);
    double sum = 0.0;
    int count = 0;
    for (int kx = -largest; kx <= largest; ++kx)
        for (int ky = 0; ky <= largest; ++ky) {
            const double k = std::sqrt(double(kx * kx + ky * ky));
            if (k < std::max(1.5, from * root) || k > to * root) continue;
            std::complex<double> amplitude = 0.0;
            for (const Vec3& p : s.positions)
                amplitude += std::polar(1.0, -2.0 * M_PI * (kx * double(p.x) + ky * double(p.y)));
            sum += std::norm(amplitude) / double(s.size()), ++count;
        }
    return sum / count;
}

}  // namespace

TEST_CASE("blue-noise points keep their distance and have no low frequencies", "[surface_points]") {
    const Surfels blue = blue_noise_surfels(plate(), 1000);
    Surfels independent = blue;
    Rng rng(1);
    for (Vec3& p : independent.positions) p = Vec3(rng.next_vec2(), 0.0f);
    REQUIRE(blue.size() == 1000);
    INFO(distance_ratio(blue) << " against " << distance_ratio(independent));
    // Lagae & Dutre 2008: good sets of this kind lie between 0.65 and 0.85.
    CHECK(distance_ratio(blue) > 0.65);
    CHECK(distance_ratio(independent) < 0.3);
    // Independent points have 1 everywhere.
    CHECK(power(blue, 0.0, 0.5) < 0.2);
    CHECK(power(blue, 0.9, 1.1) > 1.5);
    CHECK(power(independent, 0.0, 0.5) > 0.8);
}

TEST_CASE("points have equal areas, on both sides of a thin wall, and their discs hide it",
          "[surface_points]") {
    const SurfaceTriangles room =
        TriangleBuilder().box({0, 0, 0}, {4, 3, 5}, true, 0).box({1, 1, 1}, {1.01f, 2, 3}, false, 6).list();
    const Surfels s = blue_noise_surfels(room, 4000);
    std::vector<double> found(room.size()), area(room.size());
    for (const SurfacePoint& p : s.places) found[p.triangle] += s.patch();
    for (std::size_t i = 0; i < room.size(); ++i) {
        area[i] = triangle_area(room.corners[i]);
        // At a border points have neighbours on one side only: half a distance of it counts for more.
        const auto& c = room.corners[i];
        const double border =
            double(glm::length(c[1] - c[0]) + glm::length(c[2] - c[1]) + glm::length(c[0] - c[2])) *
            std::sqrt(s.patch());
        CHECK(std::fabs(found[i] - area[i]) < 0.25 * border + 2.0 * s.patch());
    }
    // No place of the room is farther from a point of its side than a disc's radius. On the narrow sides of
    // the thin box candidates are one behind the other, as far apart as their share of the area is long
    // there.
    const float strip = s.radius + float(s.patch() / 8.0 / 0.01);
    std::vector<SurfacePoint> places;
    SurfacePoints(room).sample(99, 5000, 0, 5000, places);
    for (const SurfacePoint& place : places) {
        const auto& c = room.corners[place.triangle];
        const Vec3 p = c[0] + place.u * (c[1] - c[0]) + place.v * (c[2] - c[0]);
        const Vec3 n = glm::normalize(glm::cross(c[1] - c[0], c[2] - c[0]));
        float nearest = infinity;
        for (std::size_t i = 0; i < s.size(); ++i)
            if (glm::dot(n, s.normals[i]) > 0.9f)
                nearest = std::min(nearest, glm::length(p - s.positions[i]));
        const bool on_strip = place.triangle >= 12 && std::fabs(n.x) < 0.5f;
        CHECK(nearest <= (on_strip ? strip : s.radius));
    }
    CHECK(s.radius < 1.2f * float(std::sqrt(s.patch())));
}

TEST_CASE("points on surfaces at the extremes", "[surface_points]") {
    const SurfaceTriangles nothing, line = TriangleBuilder().triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).list();
    CHECK(blue_noise_surfels(nothing, 100).size() == 0);
    CHECK(blue_noise_surfels(line, 100).size() == 0);
    CHECK(blue_noise_surfels(plate(), 0).size() == 0);
    const Surfels one = blue_noise_surfels(plate(), 1);
    REQUIRE(one.size() == 1);
    CHECK((is_finite(one.radius) && one.radius > 0.0f));
    CHECK_THROWS_AS(blue_noise_surfels(plate(), 10, {.candidates = 0}), InputError);
    CHECK_THROWS_WITH(blue_noise_surfels(plate(), 1u << 24, {.memory_budget = 1 << 20}),
                      ContainsSubstring("16777216 points") && ContainsSubstring("fit into the"));
    const Surfels a = blue_noise_surfels(plate(), 500), b = blue_noise_surfels(plate(), 500, {.seed = 2});
    CHECK(a.positions == blue_noise_surfels(plate(), 500).positions);
    CHECK(a.positions != b.positions);
}
