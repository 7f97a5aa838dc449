// Rays that leave a surface must not meet it again, and must still meet what lies just behind them.
#include "core/geometry/rounding.h"
#include "core/objects/error.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

/// Random triangles of several kinds: coordinates between 1e-8 and 1e8 mixed at random, needles, small
/// triangles far away from the origin, and triangles of one size anywhere between 1e-8 and 1e8.
MeshData random_triangle(int kind, Rng& rng) {
    const auto log_uniform = [&](float low, float high) {
        const float sign = rng.next_float() < 0.5f ? -1.0f : 1.0f;
        return sign * std::pow(10.0f, lerp(low, high, rng.next_float()));
    };
    Vec3 v[3];
    for (Vec3& p : v) p = square_to_sphere(rng.next_vec2());
    if (kind == 0)
        for (Vec3& p : v) p = {log_uniform(-8, 8), log_uniform(-8, 8), log_uniform(-8, 8)};
    if (kind == 1)
        v[2] = 0.5f * (v[0] + v[1]) + std::fabs(log_uniform(-4, 0)) * square_to_sphere(rng.next_vec2());
    if (kind == 2) {
        const Vec3 away = std::fabs(log_uniform(0, 3)) * square_to_sphere(rng.next_vec2());
        for (Vec3& p : v) p = away + 0.1f * p;
    }
    if (kind == 3) {
        const float size = std::fabs(log_uniform(-8, 8));
        for (Vec3& p : v) p = size * p;
    }
    return one_triangle(v[0], v[1], v[2]);
}

}  // namespace

TEST_CASE("rays leaving a triangle never hit it again", "[geometry][offset]") {
    Rng rng(1);
    int triangles = 0, wrong = 0;
    long rays = 0;
    while (triangles < 1000) {
        std::shared_ptr<TriangleMesh> triangle;
        try {
            triangle = mesh(random_triangle(triangles % 4, rng));
        } catch (const InputError&) {
            continue;  // without area
        }
        ++triangles;
        const std::shared_ptr<Shape> shapes[] = {triangle};
        const RayTracer tracer(shapes);
        for (int i = 0; i < 1000; ++i) {
            SurfaceHit hit;
            Vec2 b = square_to_triangle(rng.next_vec2());
            if (i % 10 == 0) b.y = 0.0f;  // on an edge
            triangle->fill_hit(0, b.x, b.y, hit);
            const Vec3 direction = square_to_sphere(rng.next_vec2());
            const Ray leaving = ray(offset_origin(hit, direction), direction);
            wrong += tracer.occluded(leaving) || tracer.closest(leaving).has_value();
            ++rays;
        }
    }
    CHECK(rays == 1000000);
    CHECK(wrong == 0);
}

TEST_CASE("hits found by rays leave no trace of themselves", "[geometry][offset]") {
    // Origins at hits that Embree reports, on a closed mesh, from both sides.
    const auto ball = mesh(sphere_mesh({3, -2, 7}, 2.0f, 64, 32));
    const std::shared_ptr<Shape> shapes[] = {ball};
    const RayTracer tracer(shapes);
    Rng rng(2);
    int inside = 0, outside = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 direction = square_to_sphere(rng.next_vec2());
        const auto hit = tracer.closest(ray({3, -2, 7}, direction));
        REQUIRE(hit);
        const Vec3 out = hit->shading.to_world(square_to_cosine_hemisphere(rng.next_vec2()));
        // A sphere mesh is convex: outwards nothing is met, inwards the far side and never this triangle.
        outside += tracer.occluded(ray(offset_origin(*hit, out), out));
        const auto next = tracer.closest(ray(offset_origin(*hit, -out), -out));
        inside += next && next->primitive == hit->primitive;
    }
    CHECK(outside == 0);
    CHECK(inside == 0);
}

TEST_CASE("a wall one thousandth away is not skipped", "[geometry][offset]") {
    // Two parallel triangles, the gap a thousandth of their size, at all scales and orientations.
    Rng rng(3);
    int leaks = 0;
    for (int i = 0; i < 1000; ++i) {
        const float size = std::pow(10.0f, lerp(-8.0f, 8.0f, rng.next_float()));
        const Frame frame(square_to_sphere(rng.next_vec2()));
        const Vec3 center = 2.0f * size * square_to_sphere(rng.next_vec2());
        const auto corner = [&](float angle, float height) {
            return center + size * frame.to_world({std::cos(angle), std::sin(angle), height});
        };
        const auto wall = [&](float height, float scale) {
            MeshData data = one_triangle(corner(0.0f, height), corner(2.1f, height), corner(4.2f, height));
            for (Vec3& p : data.positions) p = center + scale * (p - center);
            return mesh(std::move(data));
        };
        const std::shared_ptr<Shape> shapes[] = {wall(0.0f, 1.0f), wall(1e-3f, 1.5f)};
        const RayTracer tracer(shapes);
        for (int k = 0; k < 20; ++k) {
            SurfaceHit hit;
            const Vec2 b = square_to_triangle(rng.next_vec2());
            static_cast<const TriangleMesh&>(*shapes[0]).fill_hit(0, b.x, b.y, hit);
            const auto next = tracer.closest(ray(offset_origin(hit, frame.n), frame.n));
            leaks += !next || next->shape != shapes[1].get();
        }
    }
    CHECK(leaks == 0);
}

TEST_CASE("the offset is as small as rounding allows", "[geometry][offset]") {
    // On an axis-aligned plane nothing is uncertain but the rounding of one coordinate.
    const auto floor = mesh(one_triangle({0, 0, 3.3f}, {1000, 0, 3.3f}, {0, 1000, 3.3f}));
    SurfaceHit hit;
    floor->fill_hit(0, 0.3f, 0.4f, hit);
    const Vec3 up = offset_origin(hit, {0, 0, 1}), down = offset_origin(hit, {0, 0, -1});
    CHECK(up.x == hit.position.x);
    CHECK(up.z > 3.3f);
    CHECK(up.z <= std::nextafter(std::nextafter(3.3f, 4.0f), 4.0f));
    CHECK(down.z < 3.3f);
    CHECK(down.z >= std::nextafter(std::nextafter(3.3f, 0.0f), 0.0f));
    // In general position it stays within some ulps of the triangle's size.
    const auto tilted = mesh(one_triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}));
    tilted->fill_hit(0, 0.3f, 0.4f, hit);
    CHECK(hit.error < 2e-6f);
    CHECK(hit.error > 1e-8f);
}

TEST_CASE("rays leaving spheres, disks and cylinders never hit them again", "[geometry][offset][quadrics]") {
    Rng rng(4);
    int wrong = 0, wrong_chords = 0;
    for (int i = 0; i < 300; ++i) {
        const float scale = std::pow(10.0f, lerp(-8.0f, 8.0f, rng.next_float()));
        const Vec3d at =
            Vec3d(scale * std::pow(10.0f, 2.0f * rng.next_float()) * square_to_sphere(rng.next_vec2()));
        const Transform place =
            translation(at.x, at.y, at.z) *
            rotation(360.0 * double(rng.next_float()), Vec3d(square_to_sphere(rng.next_vec2()))) *
            scaling(scale, scale, scale);
        const std::shared_ptr<Shape> shapes[] = {
            i % 3 == 0   ? make_sphere({0, 0, 0}, 1.0, place, false)
            : i % 3 == 1 ? make_disk(place, false)
                         : make_cylinder({0, 0, 0}, {0, 0, 1}, 1.0, place, false)};
        const RayTracer tracer(shapes);
        for (int k = 0; k < 300; ++k) {
            const ShapeSample sample = shapes[0]->sample_area(rng.next_vec2());
            Vec3 direction = square_to_sphere(rng.next_vec2());
            // Outwards, where a sphere and a cylinder are convex; a disk has no inside at all.
            if (i % 3 != 1 && glm::dot(direction, sample.normal) < 0.0f) direction = -direction;
            const Vec3 origin = offset_origin(sample.position, sample.normal, sample.error, direction);
            wrong += tracer.occluded(ray(origin, direction));
            if (i % 3 == 0) {
                // Inwards the far side is met, at the distance of the chord.
                const Vec3 inwards = offset_origin(sample.position, sample.normal, sample.error, -direction);
                const auto far = tracer.closest(ray(inwards, -direction));
                const float chord = 2.0f * scale * glm::dot(direction, sample.normal);
                wrong_chords += chord > 0.05f * scale && !(far && std::fabs(far->t - chord) < 1e-2f * chord);
            }
        }
    }
    CHECK(wrong == 0);
    CHECK(wrong_chords == 0);
}

TEST_CASE("rounding away leaves the start", "[geometry][offset]") {
    for (const float start : {0.0f, 1.0f, -1.0f, 1e-30f, 3e8f}) {
        CHECK(round_away(double(start), start) == start);
        CHECK(round_away(double(start) + 1e-300, start) >= start);
        CHECK(round_away(double(start) + 1e-3, start) > start);
        CHECK(double(round_away(double(start) - 1e-3, start)) <= double(start) - 1e-3);
    }
    CHECK(round_away(1.0 + 1e-12, 1.0f) > 1.0f);
    CHECK(round_away(1.0 - 1e-12, 1.0f) < 1.0f);
}
