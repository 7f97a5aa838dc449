// Directions around an axis: their density, and how they are spread.
#include "lights/emitters/even_angle.h"

#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;

TEST_CASE("Directions whose angles to an axis are even have the density that they claim", "[even_angle]") {
    constexpr int side = 400;
    for (const Vec3& axis : {Vec3(0, 0, 1), Vec3(0, 0, -2e-6f), Vec3(30, -40, 120), Vec3(1e-3f, 1, 0)}) {
        const Vec3 unit = glm::normalize(axis), across = Frame(unit).s;
        double solid_angle = 0.0, cosine = 0.0, one_side = 0.0, angle = 0.0;
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j) {
                const Vec2 u((float(i) + 0.5f) / side, (float(j) + 0.5f) / side);
                const auto w = lights::sample_even_angle(axis, u);
                REQUIRE(w);
                const double p = double(lights::even_angle_pdf(axis, *w)), along = double(glm::dot(*w, unit));
                REQUIRE((p > 0.0 && std::fabs(double(glm::length(*w)) - 1.0) < 1e-6));
                solid_angle += 1.0 / p, cosine += along / p;
                one_side += double(glm::dot(*w, across) > 0.0f) / p, angle += std::acos(std::min(along, 1.0));
            }
        const double count = double(side) * side, half_sphere = 2.0 * double(pi);
        CHECK(solid_angle / count == Approx(half_sphere).epsilon(1e-4));
        CHECK(cosine / count == Approx(0.5 * half_sphere).epsilon(1e-4));
        CHECK(one_side / count == Approx(0.5 * half_sphere).epsilon(1e-4));
        CHECK(angle / count == Approx(0.25 * double(pi)).epsilon(1e-3));
    }
    CHECK(lights::even_angle_pdf(Vec3(0, 0, 1), Vec3(0, 0.6f, -0.8f)) == 0.0f);
    CHECK(lights::even_angle_pdf(Vec3(0, 0, 3), Vec3(0, 0, 1)) > 1e5f);  // along the axis it is finite
    CHECK_FALSE(lights::sample_even_angle(Vec3(0.0f), Vec2(0.5f)));
    CHECK_FALSE(lights::sample_even_angle(Vec3(infinity, 0, 0), Vec2(0.5f)));
}
