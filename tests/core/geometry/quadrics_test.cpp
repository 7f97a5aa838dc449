// Sphere, disk and cylinder against their formulas, far away, mirrored, and as lights.
#include "core/objects/error.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"

using namespace mote::tests;

namespace {

SurfaceHit hit_of(const AnalyticShape& shape, const Ray& r) {
    const auto t = shape.intersect(r.origin, r.direction, r.t_min, r.t_max);
    REQUIRE(t);
    SurfaceHit hit;
    shape.fill_hit(r.origin, r.direction, *t, hit);
    return hit;
}

}  // namespace

TEST_CASE("sphere: distances, normals, texture coordinates", "[geometry][quadrics]") {
    const auto sphere = make_sphere({1, 2, 3}, 2.0, Transform(), false);
    const SurfaceHit front = hit_of(*sphere, ray({1, 2, 13}, {0, 0, -1}));
    CHECK(front.t == Approx(8.0));
    CHECK(front.geometric_normal == Vec3(0, 0, 1));
    CHECK(front.uv.y == Approx(0.0).margin(1e-6));
    const SurfaceHit inside = hit_of(*sphere, ray({1, 2, 3}, {0, 1, 0}));
    CHECK(inside.t == Approx(2.0));
    CHECK(inside.geometric_normal == Vec3(0, 1, 0));
    CHECK(inside.uv.x == Approx(0.25));
    CHECK(inside.uv.y == Approx(0.5));
    CHECK(hit_of(*sphere, ray({1, 2, 3}, {0, -1, 0})).uv.x == Approx(0.75));
    CHECK_FALSE(sphere->intersect({1, 2, 13}, {0, 0, -1}, 0.0f, 7.9f));
    CHECK(*sphere->intersect({1, 2, 13}, {0, 0, -1}, 8.5f, 100.0f) == Approx(12.0));
    CHECK_FALSE(sphere->intersect({1, 2, 13}, {0, 0, 1}, 0.0f, infinity));
    CHECK(sphere->area() == Approx(16.0 * double(pi)));
    CHECK(sphere->closed());
    CHECK(sphere->line_hits({1, 2, 13}, {0, 0, -2}).t[0] == Approx(4.0));  // any length of direction
    CHECK(hit_of(*make_sphere({0, 0, 0}, 1.0, Transform(), true), ray({0, 0, 5}, {0, 0, -1}))
              .geometric_normal.z < 0);
}

TEST_CASE("sphere: nothing cancels far away", "[geometry][quadrics]") {
    // A sphere of radius 1e-3 seen from 1e5 away: 53 bits suffice where the textbook formula in 24 fails.
    const auto sphere = make_sphere({0, 0, 0}, 1e-3, Transform(), false);
    const double heights[] = {0.0, 0.5e-3, 0.9e-3, 0.999e-3};
    for (const double h : heights) {
        const auto hits = sphere->line_hits({1e5f, float(h), 0}, {-1, 0, 0});
        REQUIRE(hits.count == 2);
        const double half = std::sqrt(1e-6 - double(float(h)) * double(float(h)));
        CHECK(hits.t[1] - hits.t[0] == Approx(2.0 * half).epsilon(1e-6));
    }
    CHECK(sphere->line_hits({1e5f, 1.0001e-3f, 0}, {-1, 0, 0}).count == 0);
}

TEST_CASE("a sphere stays a sphere under any transform, as Mitsuba's does", "[geometry][quadrics]") {
    // Mitsuba 3.9.1 under a scale of 2, 1, 3: radius 2, the first hit of this ray at 3.267949, and a warning.
    const auto sphere = make_sphere({0, 0, 0}, 1.0, scaling(2, 1, 3), false);
    CHECK(hit_of(*sphere, ray({5, 0, 1}, {-1, 0, 0})).t == Approx(3.267949));
    CHECK(sphere->area() == Approx(50.26548));
    REQUIRE(sphere->notes.size() == 1);
    CHECK(make_sphere({0, 0, 0}, 1.0, scaling(2, -2, 2), false)->notes.empty());
}

TEST_CASE("a cylinder under any affine transform", "[geometry][quadrics][sampling]") {
    // Numbers of Mitsuba 3.9.1 (a scale of 2, 1, 3): hits and normals of an elliptic cylinder.
    const auto stretched = make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, scaling(2, 1, 3), false);
    const SurfaceHit hit = hit_of(*stretched, ray({5, 0.5f, 1}, {-1, 0, 0}));
    CHECK(hit.t == Approx(3.267949));
    CHECK(hit.geometric_normal.x == Approx(0.654654));
    CHECK(hit.geometric_normal.y == Approx(0.755929));
    CHECK(hit.uv.x == Approx(0.0833334));
    CHECK(hit.uv.y == Approx(1.0 / 3.0));
    // The perimeter of an ellipse of half axes 2 and 1 is 9.688448220547676.
    CHECK(stretched->area() == Approx(3.0 * 9.688448220547676));
    CHECK(make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, scaling(1, 1, 3), false)->area() ==
          Approx(6.0 * double(pi)));
    // Uniform by area, also where it is sheared: as many points as area between two angles.
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.5, shear[2][1] = 0.7;
    for (const Transform& place : {scaling(8, 1, 1), Transform(shear)}) {
        const auto shape = make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, place, false);
        constexpr int cells = 16, n = 40000;
        double expected[cells] = {}, total = 0.0, chi2 = 0.0;
        const Vec3d z = place.vector({0, 0, 1});
        for (int i = 0; i < cells * 1000; ++i) {
            const double a = 2.0 * double(pi) * (i + 0.5) / (cells * 1000);
            const double area = glm::length(glm::cross(place.vector({-std::sin(a), std::cos(a), 0}), z));
            expected[i / 1000] += area, total += area;
        }
        CHECK(double(shape->area()) == Approx(total * 2.0 * double(pi) / (cells * 1000)).epsilon(1e-5));
        int found[cells] = {};
        Rng rng(12);
        for (int i = 0; i < n; ++i)
            ++found[std::min(cells - 1, int(shape->sample_area(rng.next_vec2()).uv.x * float(cells)))];
        for (int i = 0; i < cells; ++i) {
            const double e = expected[i] / total * n;
            chi2 += (found[i] - e) * (found[i] - e) / e;
        }
        CHECK(chi2 < 30.58);  // 15 degrees of freedom at 1 %
    }
}

TEST_CASE("transforms of quadrics: none that is singular, and mirrors keep outside out",
          "[geometry][quadrics]") {
    CHECK_THROWS_AS(make_sphere({0, 0, 0}, 1.0, scaling(1, 0, 1), false), InputError);
    CHECK_THROWS_AS(make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, scaling(1, 1, 0), false), InputError);
    CHECK_THROWS_AS(make_disk(scaling(1, 0, 1), false), InputError);
    CHECK_THROWS_AS(make_sphere({0, 0, 0}, -1.0, Transform(), false), InputError);
    CHECK_THROWS_AS(make_cylinder({0, 0, 0}, {0, 0, 0}, 1.0, Transform(), false), InputError);
    CHECK_THROWS_AS(make_sphere({std::nan(""), 0, 0}, 1.0, Transform(), false), InputError);

    const Transform mirror = translation(1, 0, 0) * scaling(-2, 2, 2);
    const auto sphere = make_sphere({1, 0, 0}, 1.0, mirror, false);
    const SurfaceHit hit = hit_of(*sphere, ray({-11, 0, 0}, {1, 0, 0}));
    CHECK(hit.t == Approx(8.0));  // centre at -1, radius 2
    CHECK(hit.geometric_normal.x == Approx(-1.0));
    const auto cylinder = make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, mirror, false);
    CHECK(hit_of(*cylinder, ray({-11, 0, 1}, {1, 0, 0})).geometric_normal.x == Approx(-1.0));
    // A disk faces where its +z goes.
    CHECK(hit_of(*make_disk(scaling(-1, 1, 1), false), ray({0, 0, 5}, {0, 0, -1})).geometric_normal.z ==
          Approx(1.0));
    CHECK(hit_of(*make_disk(scaling(1, 1, -1), false), ray({0, 0, 5}, {0, 0, -1})).geometric_normal.z ==
          Approx(-1.0));
}

TEST_CASE("disk and cylinder: distances, borders, areas, texture coordinates", "[geometry][quadrics]") {
    const auto disk = make_disk(translation(0, 0, 1) * scaling(2, 3, 1), false);
    CHECK(disk->area() == Approx(6.0 * double(pi)));
    const SurfaceHit d = hit_of(*disk, ray({1, 0, 5}, {0, 0, -1}));
    CHECK(d.t == Approx(4.0));
    CHECK(d.uv.x == Approx(0.5));
    CHECK(d.uv.y == Approx(0.0).margin(1e-6));
    CHECK(disk->intersect({0, 2.99f, 5}, {0, 0, -1}, 0.0f, infinity));
    CHECK_FALSE(disk->intersect({0, 3.01f, 5}, {0, 0, -1}, 0.0f, infinity));
    CHECK_FALSE(disk->intersect({0, 0, 1}, {1, 0, 0}, 0.0f, infinity));

    const auto cylinder = make_cylinder({0, 0, 1}, {0, 0, 5}, 0.5, Transform(), false);
    CHECK(cylinder->area() == Approx(4.0 * double(pi)));
    const SurfaceHit c = hit_of(*cylinder, ray({3, 0, 2}, {-1, 0, 0}));
    CHECK(c.t == Approx(2.5));
    CHECK(c.geometric_normal.x == Approx(1.0));
    CHECK(c.uv.y == Approx(0.25));
    CHECK(hit_of(*cylinder, ray({0, 0, 2}, {0, 1, 0})).t == Approx(0.5));  // from inside
    CHECK_FALSE(cylinder->intersect({3, 0, 0.9f}, {-1, 0, 0}, 0.0f, infinity));
    CHECK_FALSE(cylinder->intersect({0.2f, 0, -5}, {0, 0, 1}, 0.0f, infinity));  // through the open ends
    CHECK_FALSE(cylinder->closed());
}

TEST_CASE("bounds hold every point of a quadric", "[geometry][quadrics]") {
    Rng rng(10);
    for (int i = 0; i < 60; ++i) {
        const Transform place = translation(100 * rng.next_float(), 5, -3) *
                                rotation(360 * rng.next_float(), Vec3d(square_to_sphere(rng.next_vec2())));
        const std::shared_ptr<AnalyticShape> shape =
            i % 3 == 0   ? make_sphere({0, 0, 0}, 1.0, place, false)
            : i % 3 == 1 ? make_disk(place * scaling(1, 3, 1), false)
                         : make_cylinder({0, 0, 0}, {0, 1, 2}, 0.3, place, false);
        const Bounds3 box = shape->bounds();
        Bounds3 seen;
        for (int k = 0; k < 2000; ++k) {
            const Vec3 p = shape->sample_area(rng.next_vec2()).position;
            CHECK(box.contains(p));
            seen.extend(p);
        }
        CHECK(glm::all(glm::lessThan(glm::abs(box.diagonal() - seen.diagonal()), Vec3(0.15f))));
    }
}

TEST_CASE("areas and uniformity of quadric samples", "[geometry][quadrics][sampling]") {
    // Moments over the surface: mean position, and mean square of one coordinate, each within 4 sigma.
    const int n = 40000;
    struct Case {
        std::shared_ptr<AnalyticShape> shape;
        Vec3d mean, mean_square;
    };
    const Case cases[] = {
        {make_sphere({1, 0, 0}, 3.0, Transform(), false), {1, 0, 0}, {4, 3, 3}},  // r^2 / 3 on each axis
        {make_disk(scaling(2, 2, 1), false), {0, 0, 0}, {1, 1, 0}},               // r^2 / 4
        {make_cylinder({0, 0, 0}, {0, 0, 6}, 2.0, Transform(), false), {0, 0, 3}, {2, 2, 12}}};
    Rng rng(11);
    for (const Case& c : cases) {
        Vec3d mean(0.0), square(0.0);
        for (int i = 0; i < n; ++i) {
            const ShapeSample s = c.shape->sample_area(rng.next_vec2());
            mean += Vec3d(s.position) / double(n), square += Vec3d(s.position * s.position) / double(n);
            CHECK(s.pdf_area * c.shape->area() == Approx(1.0));
            CHECK(glm::length(s.normal) == Approx(1.0));
        }
        for (int axis = 0; axis < 3; ++axis) {
            // sigma of a coordinate is at most 3, of its square at most 11.
            CHECK(std::fabs(mean[axis] - c.mean[axis]) < 4.0 * 3.0 / std::sqrt(double(n)));
            CHECK(std::fabs(square[axis] - c.mean_square[axis]) < 4.0 * 11.0 / std::sqrt(double(n)));
        }
    }
}

TEST_CASE("sampling the visible sphere matches its density", "[geometry][quadrics][sampling]") {
    const auto sphere = make_sphere({0, 0, 4}, 1.5, Transform(), false);
    const std::shared_ptr<Shape> shapes[] = {sphere};
    const RayTracer tracer(shapes);
    // Far, near, almost touching, and inside.
    const Vec3 points[] = {{0, 0, -3}, {0.5f, 0.2f, 2.2f}, {0, 0, 2.499f}, {0.7f, 0, 4.2f}};
    for (const Vec3& p : points) {
        const Vec3 center(0, 0, 4);
        const bool inside = glm::length(p - center) < 1.5f;
        const auto sampler = [&](Rng& rng) -> std::optional<Vec3> {
            float pdf = 0.0f;
            const auto s = sphere->sample_visible(p, rng.next_vec2(), pdf);
            if (!s) return std::nullopt;
            CHECK(glm::length(s->position - center) == Approx(1.5));
            const Vec3 wi = glm::normalize(s->position - p);
            // The two densities agree, and the sample is not on the far side.
            SurfaceHit hit;
            hit.position = s->position, hit.geometric_normal = s->normal;
            CHECK(sphere->pdf_visible(p, wi, hit) == Approx(pdf).epsilon(1e-3));
            if (!inside) CHECK(glm::dot(wi, s->normal) < 1e-3f);
            return wi;
        };
        const auto density = [&](const Vec3& w) {
            const auto hit = tracer.closest(ray(p, w));
            return hit ? double(sphere->pdf_visible(p, w, *hit)) : 0.0;
        };
        Chi2Options options;
        options.name = "sphere light", options.samples = 60000, options.tests = 4;
        options.frame = Frame(glm::normalize(inside ? Vec3(0, 0, 1) : center - p));
        const double d = double(glm::length(center - p));
        options.cap = inside ? 2.0 : 1.25 * (1.0 - std::sqrt(std::fmax(0.0, 1.0 - 2.25 / (d * d))));
        options.cos_cells = 10, options.subdivisions = 3;
        const Chi2Result result = chi2_test(sampler, density, options);
        INFO(result.message);
        CHECK(result.passed);
        CHECK(result.integral == Approx(1.0).epsilon(2e-3));
    }
    // Tiny and far away: finite.
    float pdf = 0.0f;
    const auto star = make_sphere({0, 0, 1e6}, 1e-3, Transform(), false);
    const auto s = star->sample_visible({0, 0, 0}, {0.3f, 0.7f}, pdf);
    REQUIRE(s);
    CHECK(double(pdf) == Approx(1e18 / double(pi)).epsilon(1e-3));
}
