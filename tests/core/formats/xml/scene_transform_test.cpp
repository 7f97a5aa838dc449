// Transforms against matrices worked out by hand.
#include "tests/core/scene/scene_fixture.h"

using namespace mote::core;
using namespace mote::tests;

namespace {

Transform transform_of(const std::string& operations) {
    const auto scene = load_body("<integrator type='fake'><transform name='to_world'>" + operations +
                                 "</transform></integrator>");
    return value_of<Transform>(integrator_of(*scene), "to_world");
}

/// The rows of the matrix that is expected.
void check(const Transform& t, std::initializer_list<double> rows) {
    std::size_t i = 0;
    for (const double expected : rows) {
        INFO("row " << i / 4 << " column " << i % 4);
        CHECK(t.matrix[int(i % 4)][int(i / 4)] == Approx(expected).margin(1e-12));
        ++i;
    }
}

}  // namespace

TEST_CASE("Single transformations", "[scene][transform]") {
    check(transform_of(""), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    check(transform_of("<translate x='1' z='3'/>"), {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 3, 0, 0, 0, 1});
    check(transform_of("<translate value='1, 2, 3'/>"), {1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1});
    check(transform_of("<scale x='2'/>"), {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    check(transform_of("<scale value='3'/>"), {3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1});
    // counter-clockwise: x turns towards y about z
    check(transform_of("<rotate z='1' angle='90'/>"), {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    check(transform_of("<rotate x='1' angle='90'/>"), {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1});
    check(transform_of("<rotate value='0 5 0' angle='90'/>"),
          {0, 0, 1, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 0, 1});
    check(transform_of("<matrix value='1 2 3 4 5 6 8 8 9 10 12 12 0 0 0 1'/>"),
          {1, 2, 3, 4, 5, 6, 8, 8, 9, 10, 12, 12, 0, 0, 0, 1});
    check(transform_of("<matrix value='0 2 0 2 0 0 0 0 2'/>"),
          {0, 2, 0, 0, 2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1});
}

TEST_CASE("Transformations multiply from the left in order", "[scene][transform]") {
    // (1,0,0) -> scaled (2,0,0) -> moved (2,1,0) -> turned (-1,2,0)
    const Transform t = transform_of("<scale value='2'/><translate y='1'/><rotate z='1' angle='90'/>");
    const Vec3d p = t.point({1, 0, 0});
    CHECK(p.x == Approx(-1));
    CHECK(p.y == Approx(2));
    CHECK(p.z == Approx(0).margin(1e-12));
    check(t, {0, -2, 0, -1, 2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1});
}

TEST_CASE("lookat: +Z to the target, +X to the left", "[scene][transform]") {
    // From the origin along world +z with y up, left is world +x: the identity.
    check(transform_of("<lookat origin='0 0 0' target='0 0 7' up='0 3 0'/>"),
          {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    // Looking along -z from (0,1,4), left is world -x.
    check(transform_of("<lookat origin='0 1 4' target='0 1 0' up='0 1 0'/>"),
          {-1, 0, 0, 0, 0, 1, 0, 1, 0, 0, -1, 4, 0, 0, 0, 1});
    // up need not be perpendicular to the view
    const Transform t = transform_of("<lookat origin='1 2 3' target='4 6 3' up='0 0 1'/>");
    CHECK(t.vector({0, 0, 1}).x == Approx(0.6));
    CHECK(t.vector({0, 0, 1}).y == Approx(0.8));
    CHECK(t.vector({0, 1, 0}).z == Approx(1.0));
    CHECK(t.determinant() == Approx(1.0));
}
