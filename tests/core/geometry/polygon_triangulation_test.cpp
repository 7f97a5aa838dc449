// Polygons: the area is kept, concave corners are respected, and nothing hangs.
#include "core/geometry/polygon_triangulation.h"

#include <numeric>

#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

/// Areas of the triangles, and the length of the sum of their normals: equal when none is turned over. That
/// sum is the vector area of the polygon, whether it crosses itself or not.
std::pair<double, double> areas(const std::vector<Vec3>& p) {
    std::vector<std::uint32_t> polygon(p.size());
    std::iota(polygon.begin(), polygon.end(), 0u);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangulate_polygon(polygon, p, triangles);
    CHECK(triangles.size() == p.size() - 2);
    double sum = 0.0;
    Vec3d normal(0.0);
    for (const auto& t : triangles) {
        CHECK((t[0] != t[1] && t[1] != t[2] && t[2] != t[0]));
        const Vec3d n = 0.5 * glm::cross(Vec3d(p[t[1]] - p[t[0]]), Vec3d(p[t[2]] - p[t[0]]));
        sum += glm::length(n), normal += n;
    }
    Vec3d vector_area(0.0);
    for (std::size_t i = 0; i < p.size(); ++i)
        vector_area += 0.5 * glm::cross(Vec3d(p[i]), Vec3d(p[(i + 1) % p.size()]));
    CHECK(glm::length(normal - vector_area) < 1e-9 * double(p.size()));
    return {sum, glm::length(normal)};
}

}  // namespace

TEST_CASE("polygons keep their area", "[geometry][polygon]") {
    const std::vector<Vec3> arrow = {{0, 0, 0}, {2, 0, 0}, {0.5f, 0.5f, 0}, {0, 2, 0}};
    CHECK(areas(arrow).first == Approx(1.0));
    const std::vector<Vec3> turned = {{2, 0, 0}, {0.5f, 0.5f, 0}, {0, 2, 0}, {0, 0, 0}};
    CHECK(areas(turned).first == Approx(1.0));
    const std::vector<Vec3> clockwise = {{0, 2, 1}, {0.5f, 0.5f, 1}, {2, 0, 1}, {0, 0, 1}};
    CHECK(areas(clockwise).first == Approx(1.0));
    // A star of 40 corners, tilted.
    std::vector<Vec3> star;
    double expected = 0.0;
    const Frame frame(glm::normalize(Vec3(1, -2, 0.5f)));
    for (int i = 0; i < 40; ++i) {
        const float a = 2.0f * pi * float(i) / 40.0f, r = i % 2 ? 0.4f : 1.0f;
        star.push_back(frame.to_world({r * std::cos(a), r * std::sin(a), 3.0f}));
    }
    expected = 40 * 0.5 * 0.4 * std::sin(2.0 * double(pi) / 40.0);
    const auto [sum, oriented] = areas(star);
    CHECK(sum == Approx(expected).epsilon(1e-5));
    CHECK(oriented == Approx(expected).epsilon(1e-5));
}

TEST_CASE("polygons that cross themselves or have no area end", "[geometry][polygon]") {
    CHECK(areas({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).second == 0.0);
    CHECK(areas({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5f, 0, 0}}).first == 0.0);
    CHECK(areas({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}).first == 0.0);
    Rng rng(12);
    std::vector<Vec3> tangle;
    for (int i = 0; i < 256; ++i) tangle.push_back({rng.next_float(), rng.next_float(), rng.next_float()});
    const auto [sum, oriented] = areas(tangle);
    CHECK(sum > oriented);
}
