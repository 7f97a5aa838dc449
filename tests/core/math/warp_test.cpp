// Warps: inside their domain for all numbers, and distributed as their densities say.
#include "core/math/warp.h"

#include "core/math/pdf_conversion.h"
#include "core/math/random.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

const float ends[] = {0.0f, 1e-8f, 0.25f, 0.5f, 0.75f, one_minus_epsilon};

void check(const char* name, Vec3 (*warp)(const Vec2&), double (*density)(const Vec3&)) {
    Chi2Options options;
    options.name = name, options.samples = 150000, options.tests = 3, options.subdivisions = 2;
    const Chi2Result result =
        chi2_test([&](Rng& rng) -> std::optional<Vec3> { return warp(rng.next_vec2()); }, density, options);
    INFO(result.message);
    CHECK(result.passed);
}

}  // namespace

TEST_CASE("warps to directions follow their densities", "[math][warp]") {
    check(
        "sphere", [](const Vec2& u) { return square_to_sphere(u); },
        [](const Vec3&) { return double(inv_four_pi); });
    check(
        "cosine hemisphere", [](const Vec2& u) { return square_to_cosine_hemisphere(u); },
        [](const Vec3& w) { return double(cosine_hemisphere_pdf(w)); });
    // Half-angle with 1 - cos = 1/4: on a border of the cells.
    check(
        "cone", [](const Vec2& u) { return square_to_cone(u, 0.25f); },
        [](const Vec3& w) { return w.z >= 0.75f ? double(cone_pdf(0.25f)) : 0.0; });
}

TEST_CASE("warps stay inside their domains", "[math][warp]") {
    for (const float x : ends)
        for (const float y : ends) {
            const Vec2 u(x, y);
            CHECK(glm::length(square_to_disk(u)) <= 1.000001f);
            CHECK(glm::length(square_to_sphere(u)) == Approx(1.0));
            CHECK(square_to_cosine_hemisphere(u).z > 0.0f);
            CHECK(glm::length(square_to_cosine_hemisphere(u)) == Approx(1.0));
            CHECK(square_to_cone(u, 1e-10f).z > 0.9999f);
            CHECK(glm::length(square_to_cone(u, 1.0f)) == Approx(1.0));
            const Vec2 b = square_to_triangle(u);
            CHECK((b.x >= 0.0f && b.y >= 0.0f && b.x + b.y <= 1.000001f));
        }
}

TEST_CASE("disk and triangle are uniform", "[math][warp]") {
    // Means and mean squares within 4 sigma of the exact moments.
    Rng rng(3);
    const int n = 100000;
    double r2 = 0, r4 = 0, b1 = 0, b2 = 0, b11 = 0;
    for (int i = 0; i < n; ++i) {
        const Vec2 d = square_to_disk(rng.next_vec2()), b = square_to_triangle(rng.next_vec2());
        const double r = double(glm::dot(d, d));
        r2 += r / n, r4 += r * r / n, b1 += double(b.x) / n, b2 += double(b.y) / n,
            b11 += double(b.x * b.x) / n;
    }
    const double s = 4.0 / std::sqrt(double(n));
    CHECK(std::fabs(r2 - 1.0 / 2.0) < s * std::sqrt(1.0 / 12.0));  // r^2 is uniform
    CHECK(std::fabs(r4 - 1.0 / 3.0) < s * std::sqrt(4.0 / 45.0));
    CHECK(std::fabs(b1 - 1.0 / 3.0) < s * std::sqrt(1.0 / 18.0));
    CHECK(std::fabs(b2 - 1.0 / 3.0) < s * std::sqrt(1.0 / 18.0));
    CHECK(std::fabs(b11 - 1.0 / 6.0) < s * std::sqrt(1.0 / 15.0 - 1.0 / 36.0));
}

TEST_CASE("densities convert between area and solid angle", "[math][pdf]") {
    CHECK(area_to_solid_angle(2.0f, 9.0f, -0.5f) == Approx(36.0));
    CHECK(solid_angle_to_area(36.0f, 9.0f, 0.5f) == Approx(2.0));
    CHECK(area_to_solid_angle(2.0f, 9.0f, 0.0f) == 0.0f);
}
