// Micro-buffers and ray-bundles over a host's triangles, against closed forms of two parallel unit squares.
#include "session/host/host_triangles.h"

#include <cmath>

#include "core/objects/error.h"
#include "tests/support/catch.h"

using namespace mote;
using core::Rgb, core::Vec2, core::Vec3;

namespace {

using Corners = std::array<std::uint32_t, 3>;
const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
/// Fronts of the lower square are up, of the upper one down.
const std::vector<Corners> squares{{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};

/// Irradiance below the middle of a square of radiance 1 at distance 1 (Howell's catalogue, B-3) [W/m^2].
double irradiance_of_square(double half_side) {
    const double a = half_side, p = std::sqrt(1.0 + a * a);
    return 4.0 * a / p * std::atan(a / p);
}

double irradiance(float lamp_front, bool up) {
    const std::vector<Rgb> radiance{Rgb(0.0f), Rgb(0.0f), Rgb(lamp_front), Rgb(lamp_front)};
    const std::vector<Vec3> position{{0.5f, 0.5f, 0.01f}}, normal{{0.0f, 0.0f, up ? 1.0f : -1.0f}};
    return double(session::micro_irradiance({corners, squares}, radiance, position, normal,
                                            {.points = 8000, .side = 32, .passes = 16})[0]
                      .y);
}

double linked(const std::vector<Corners>& triangles, const Vec3& direction) {
    double area = 0.0;
    for (const session::BundleLink& link :
         session::bundle_links({corners, triangles}, direction, 1.0f / 512.0f, Vec2(0.25f)))
        area += link.area;
    return area;
}

}  // namespace

TEST_CASE("micro-buffers of a host's triangles see a square by its closed form", "[host]") {
    // Discs of points reach beyond the edge by their radius at most, sqrt(2 / (pi 8000)) times a few.
    const double least = irradiance_of_square(0.5 / 0.99), most = irradiance_of_square((0.5 + 0.04) / 0.99);
    const double found = irradiance(1.0f, true);
    CAPTURE(found, least, most);
    CHECK(found > 0.99 * least);
    CHECK(found < 1.01 * most);
    CHECK(irradiance(2.0f, true) == Approx(2.0 * found).epsilon(1e-5));
    CHECK(irradiance(1.0f, false) == 0.0);  // below the floor's back there is nothing
}

TEST_CASE("ray-bundles through a host's triangles link fronts alone, by the area that crosses", "[host]") {
    const Vec3 slanted(0.25f, 0.0f, 1.0f);  // of length sqrt(1.0625): a quarter of the square is not crossed
    const double cosine = 1.0 / std::sqrt(1.0625);
    CHECK(linked(squares, slanted) == Approx(0.75 * cosine).epsilon(0.01));  // rays at the rim: 4 of 512 rows
    CHECK(linked(squares, Vec3(0, 0, 1)) == Approx(1.0).epsilon(0.01));
    CHECK(linked({{0, 2, 1}, {0, 3, 2}, {4, 6, 5}, {4, 7, 6}}, Vec3(0, 0, 1)) == 0.0);  // a front sees a back
    const auto links = session::bundle_links({corners, squares}, Vec3(0, 0, 1), 0.01f, Vec2(0.5f));
    REQUIRE(!links.empty());
    for (const session::BundleLink& link : links) CHECK((link.from < 2 && link.to >= 2));
}

TEST_CASE("triangles of a host that cannot be are refused by name", "[host]") {
    const std::vector<Vec3> up{{0, 0, 1}}, twice{{0, 0, 2}};
    const std::vector<Corners> wrong{{0, 1, 9}};
    const std::vector<Rgb> one{Rgb(1.0f)}, four(4, Rgb(1.0f));
    CHECK_THROWS_WITH(session::bundle_links({corners, wrong}, Vec3(0, 0, 1), 0.1f, Vec2(0.0f)),
                      ContainsSubstring("triangle 0 names corner 9"));
    CHECK_THROWS_WITH(session::bundle_links({corners, squares}, Vec3(0.0f), 0.1f, Vec2(0.0f)),
                      ContainsSubstring("direction"));
    CHECK_THROWS_AS(session::bundle_links({corners, squares}, Vec3(0, 0, 1), 0.0f, Vec2(0.0f)),
                    core::InputError);
    CHECK_THROWS_WITH(session::bundle_links({corners, squares}, Vec3(0, 0, 1), 0.1f, Vec2(1.0f)),
                      ContainsSubstring("offset"));
    CHECK_THROWS_WITH(session::micro_irradiance({corners, squares}, one, up, up, {}),
                      ContainsSubstring("radiance"));
    CHECK_THROWS_WITH(session::micro_irradiance({corners, squares}, four, up, twice, {}),
                      ContainsSubstring("unit normal"));
}
