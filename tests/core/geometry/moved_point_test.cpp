// Where points of shapes go when the shapes move: where their own transforms carry them.
#include "core/geometry/moved_point.h"

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/curves.h"
#include "core/geometry/instances.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

std::shared_ptr<Shape> placed_mesh(const Transform& place) {
    MeshData data = sphere_mesh({0.2f, 0, 0}, 0.9f, 12, 6);
    transform_mesh(data, place);
    return mesh(std::move(data));
}

std::shared_ptr<Shape> placed_instance(const Transform& place) {
    auto group = std::make_shared<ShapeGroup>();
    group->shapes = {placed_mesh(Transform())};
    return place_group(group, place).front();
}

std::shared_ptr<Shape> curves_at(const Vec3& offset) {
    CurveData data;
    data.basis = CurveBasis::linear;
    data.points = {glm::vec4(offset, 0.1f), glm::vec4(offset + Vec3(1, 0.5f, 0), 0.1f)};
    data.segments = {0};
    return std::make_shared<Curves>(data);
}

/// Largest distance, over sampled points of `now`, between the position that moved_point() finds in `then`
/// and the one to which `by` carries the point.
float largest_error(const Shape& now, const Shape& then, const Transform& by) {
    float most = 0.0f;
    for (int i = 0; i < 64; ++i) {
        const Vec2 u(float(i % 8) / 8.0f + 0.05f, float(i / 8) / 8.0f + 0.07f);
        const ShapeSample sample = now.sample_area(u);
        Vec3 there(infinity);
        for (std::uint32_t k = 0; k < now.primitive_count(); ++k) {
            // The sample does not say which triangle it is on: the one that it lies in.
            const auto moved = moved_point(now, k, Vec3d(sample.position), then);
            REQUIRE(moved);
            const Vec3 expected(by.point(Vec3d(sample.position)));
            if (glm::distance(*moved, expected) < glm::distance(there, expected)) there = *moved;
        }
        most = std::max(most, glm::distance(there, Vec3(by.point(Vec3d(sample.position)))));
    }
    return most;
}

}  // namespace

TEST_CASE("points move as their shapes do", "[geometry][motion]") {
    const Transform from = translation(1, 2, 3) * rotation(20, {1, 2, 0}) * scaling(2, 2, 2),
                    to = translation(-1, 0, 3) * rotation(75, {0, 1, 1}) * scaling(3, 3, 3),
                    by = to * from.inverse();
    const auto check = [&](const auto& make) {
        const auto now = make(from), then = make(to), same = make(from);
        CHECK(largest_error(*now, *then, by) < 2e-5f);
        CHECK(largest_error(*now, *then, to) > 0.1f);  // planted: another map is seen
        CHECK(largest_error(*now, *same, Transform()) == 0.0f);
    };
    SECTION("meshes") { check(placed_mesh); }
    SECTION("instances") { check(placed_instance); }
    SECTION("spheres") {
        check([](const Transform& t) { return make_sphere({0.1, 0, 0}, 0.7, t, false); });
    }
    SECTION("disks") {
        check([](const Transform& t) { return make_disk(t, false); });
    }
    SECTION("cylinders") {
        check([](const Transform& t) { return make_cylinder({0, 0, 0}, {0, 1, 1}, 0.5, t, false); });
    }
}

TEST_CASE("curves move as a whole, deformed meshes with their triangles", "[geometry][motion]") {
    const auto moved = moved_point(*curves_at({0, 0, 0}), 0, Vec3d(0.5, 0.25, 0.1), *curves_at({1, 2, 3}));
    REQUIRE(moved);
    CHECK(glm::distance(*moved, Vec3(1.5f, 2.25f, 3.1f)) < 1e-6f);

    MeshData a = make_rectangle(), b = make_rectangle();
    for (Vec3& p : b.positions) p.z += p.x;  // a slant
    const auto now = mesh(std::move(a)), then = mesh(std::move(b));
    const auto point = moved_point(*now, 0, Vec3d(0.2, -0.4, 0.0), *then);
    REQUIRE(point);
    CHECK(glm::distance(*point, Vec3(0.2f, -0.4f, 0.2f)) < 1e-6f);
}

TEST_CASE("another shape is no place to go", "[geometry][motion]") {
    const auto ball = make_sphere({0, 0, 0}, 1.0, Transform(), false);
    const auto disk = make_disk(Transform(), false);
    const auto coarse = mesh(sphere_mesh({0, 0, 0}, 1.0f, 8, 4)),
               fine = mesh(sphere_mesh({0, 0, 0}, 1.0f, 12, 6));
    CHECK_FALSE(moved_point(*ball, 0, Vec3d(1, 0, 0), *disk));
    CHECK_FALSE(moved_point(*ball, 0, Vec3d(1, 0, 0), *coarse));
    CHECK_FALSE(moved_point(*coarse, 0, Vec3d(1, 0, 0), *fine));
    CHECK_FALSE(moved_point(*ball, 0, Vec3d(1, 0, 0), *placed_instance(Transform())));
}
