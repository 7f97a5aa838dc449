// Round curves: hits against the closed form and against Mitsuba's numbers, rays that leave them, areas.
#include "core/geometry/curves.h"

#include "core/objects/error.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

std::shared_ptr<Curves> curve(CurveBasis basis, std::vector<glm::vec4> points) {
    const std::size_t order = basis == CurveBasis::linear ? 2 : 4;
    CurveData data{basis, std::move(points), {}};
    for (std::uint32_t i = 0; i + order <= data.points.size(); ++i) data.segments.push_back(i);
    return std::make_shared<Curves>(std::move(data));
}

/// Evenly spaced control points along x: a B-spline of them is straight, from its second to its last but one.
std::shared_ptr<Curves> straight(CurveBasis basis, float radius, float scale = 1.0f) {
    std::vector<glm::vec4> points;
    for (int i = 0; i < 5; ++i) points.push_back(scale * glm::vec4(float(i), 0, 0, radius));
    return curve(basis, points);
}

const CurveBasis both[] = {CurveBasis::linear, CurveBasis::b_spline};

}  // namespace

TEST_CASE("a straight curve is a cylinder", "[geometry][curves]") {
    for (const CurveBasis basis : both)
        for (const float scale : {1e-4f, 1e-2f, 1.0f, 1e4f}) {
            // Linear pieces shorter than that are left out: Embree confuses one with its neighbour.
            if (basis == CurveBasis::linear && scale < 1e-2f) continue;
            INFO(int(basis) << ", scale " << scale);
            const std::shared_ptr<Shape> shapes[] = {straight(basis, 0.25f, scale)};
            const RayTracer tracer(shapes);
            Rng rng(1);
            for (int i = 0; i < 500; ++i) {
                const float x = 1.1f + 1.8f * rng.next_float(), z = 0.24f * (2.0f * rng.next_float() - 1.0f);
                const auto hit = tracer.closest(ray(scale * Vec3(x, 3, z), {0, -1, 0}));
                REQUIRE(hit);
                const double y = std::sqrt(0.0625 - double(z) * double(z));
                CHECK(double(hit->t / scale) == Approx(3.0 - y).epsilon(1e-4));
                CHECK(double(hit->position.y / scale) == Approx(y).margin(2e-4));
                CHECK(double(hit->geometric_normal.z) == Approx(double(z) / 0.25).margin(1e-3));
                CHECK(std::fabs(hit->geometric_normal.x) < 1e-3f);
                const double along = basis == CurveBasis::linear ? x / 4.0 : (x - 1.0) / 2.0;
                CHECK(double(hit->uv.y) == Approx(along).margin(1e-3));
                CHECK_FALSE(tracer.occluded(ray(scale * Vec3(x, 3, 0.26f), {0, -1, 0})));
            }
            // Length of the linear curve's four pieces or of the B-spline's two.
            const double length = basis == CurveBasis::linear ? 4.0 : 2.0;
            CHECK(double(shapes[0]->area()) ==
                  Approx(2.0 * double(pi) * 0.25 * length * double(scale) * double(scale)).epsilon(1e-5));
        }
}

TEST_CASE("curves have Mitsuba's hits, normals and texture coordinates", "[geometry][curves]") {
    // Numbers of Mitsuba 3.9.1, scalar_rgb, for a file of these control points.
    const std::vector<glm::vec4> points = {{0, 0, 0, 0.1f}, {1, 0, 0, 0.1f}, {2, 1, 0, 0.2f},
                                           {3, 1, 0, 0.1f}, {4, 0, 0, 0.1f}, {0, 0, 2, 0.1f},
                                           {1, 0, 2, 0.1f}, {2, 0, 2, 0.1f}, {3, 0, 2, 0.1f}};
    struct Case {
        CurveBasis basis;
        Vec3 origin, direction;
        float t;
        Vec3 normal;
        Vec2 uv;
    };
    const Vec3 o1(1.7510660f, -3, 1.7302294f), d1(-0.0376126f, 0.9102875f, -0.4122645f);
    const Vec3 o2(2.1164502f, -3, -0.7469059f), d2(0.0026723f, 0.9797524f, 0.2001952f);
    const Case cases[] = {{CurveBasis::b_spline,
                           o1,
                           d1,
                           3.8541975f,
                           {0.1851331f, -0.3268398f, 0.9267694f},
                           {0.3108556f, 0.1907203f}},
                          {CurveBasis::b_spline,
                           o2,
                           d2,
                           3.7861781f,
                           {0.4129950f, -0.9082990f, 0.0665440f},
                           {0.4894006f, 0.3532313f}},
                          {CurveBasis::linear,
                           o1,
                           d1,
                           3.8558099f,
                           {0.2570106f, -0.3570105f, 0.8980473f},
                           {0.3216732f, 0.2236852f}},
                          {CurveBasis::linear,
                           o2,
                           d2,
                           3.8934066f,
                           {0.1000013f, -0.9800160f, 0.1719554f},
                           {0.4723558f, 0.3011334f}}};
    for (const Case& c : cases) {
        CurveData data{c.basis, points, {}};
        data.segments = c.basis == CurveBasis::linear ? std::vector<std::uint32_t>{0, 1, 2, 3, 5, 6, 7}
                                                      : std::vector<std::uint32_t>{0, 1, 5};
        const std::shared_ptr<Shape> shapes[] = {std::make_shared<Curves>(std::move(data))};
        const RayTracer tracer(shapes);
        const auto hit = tracer.closest(ray(c.origin, c.direction));
        REQUIRE(hit);
        CHECK(hit->t == Approx(c.t).margin(2e-4));
        CHECK(glm::length(hit->geometric_normal - c.normal) < 4e-3f);
        CHECK(glm::length(Vec2(hit->uv) - c.uv) < 2e-3f);
    }
}

TEST_CASE("rays leaving a curve do not hit it again", "[geometry][curves][offset]") {
    Rng rng(2);
    int wrong = 0, rays = 0;
    for (const CurveBasis basis : both)
        for (int i = 0; i < 60; ++i) {
            const float scale = std::pow(10.0f, 8.0f * rng.next_float() - 4.0f);
            const float radius = std::pow(10.0f, -3.0f * rng.next_float());
            const Vec3 way = square_to_sphere(rng.next_vec2()), at = 2.0f * square_to_sphere(rng.next_vec2());
            std::vector<glm::vec4> points;
            for (int k = 0; k < 5; ++k) points.push_back(scale * glm::vec4(at + float(k) * way, radius));
            const std::shared_ptr<Shape> shapes[] = {curve(basis, points)};
            const RayTracer tracer(shapes);
            const auto at_random = [&] {
                const float x = 1.0f + 2.0f * rng.next_float();
                return scale * (at + x * way + 0.9f * radius * square_to_sphere(rng.next_vec2()));
            };
            for (int k = 0; k < 300; ++k) {
                const Vec3 to = at_random(), from = to + 5.0f * scale * square_to_sphere(rng.next_vec2());
                const auto hit = tracer.closest(ray(from, to - from));
                if (!hit) continue;
                const Vec3 out = hit->shading.to_world(square_to_cosine_hemisphere(rng.next_vec2()));
                wrong += tracer.occluded(ray(offset_origin(*hit, out), out));
                ++rays;
            }
        }
    CHECK(rays > 30000);
    CHECK(wrong == 0);
}

TEST_CASE("curves are met from outside only, in all queries and through instances", "[geometry][curves]") {
    for (const CurveBasis basis : both) {
        const std::shared_ptr<Shape> shapes[] = {straight(basis, 0.25f)};
        const RayTracer tracer(shapes);
        CHECK_FALSE(tracer.occluded(ray({2, 0, 0}, {0, 1, 0})));
        std::vector<SurfaceHit> hits;
        tracer.all_hits(ray({2.3f, 5, 0.1f}, {0, -1, 0}), RayTracer::Group::surfaces, hits);
        CHECK(hits.size() == 1);
        CHECK_FALSE(shapes[0]->closed());
    }
}

TEST_CASE("points sampled on curves have the density they claim", "[geometry][curves][sampling]") {
    const auto bent =
        curve(CurveBasis::b_spline,
              {{0, 0, 0, 0.1f}, {1, 0, 0, 0.3f}, {2, 1, 0, 0.2f}, {3, 1, 1, 0.1f}, {4, 0, 1, 0.1f}});
    const std::shared_ptr<Shape> shapes[] = {bent};
    const RayTracer tracer(shapes);
    Rng rng(4);
    const int n = 40000;
    double sum = 0.0, square = 0.0, off = 0.0;
    for (int i = 0; i < n; ++i) {
        const ShapeSample s = bent->sample_area(rng.next_vec2());
        sum += 1.0 / double(s.pdf_area), square += 1.0 / (double(s.pdf_area) * double(s.pdf_area));
        if (i % 40 != 0) continue;
        // The ray tracer finds the same point, with the same normal, from just outside.
        const auto hit = tracer.closest(ray(s.position + 0.02f * s.normal, -s.normal));
        if (!hit) continue;  // at the ends
        off = std::max(off, double(glm::length(hit->position - s.position)));
        CHECK(glm::dot(hit->geometric_normal, s.normal) > 0.999f);
        const Vec3 p = s.position + 0.5f * s.normal;
        CHECK(double(bent->pdf_visible(p, -s.normal, *hit)) ==
              Approx(0.25 * double(s.pdf_area)).epsilon(0.01));
    }
    const double mean = sum / n, sigma = std::sqrt((square / n - mean * mean) / n);
    CHECK(std::fabs(mean - double(bent->area())) <= 4.5 * sigma + 1e-3 * mean);
    CHECK(off < 2e-3);
}

TEST_CASE("curves that cannot be are refused", "[geometry][curves]") {
    const glm::vec4 p(0, 0, 0, 1);
    CHECK_THROWS_WITH(curve(CurveBasis::b_spline, {p, p, p}), ContainsSubstring("no segment"));
    CHECK_THROWS_WITH(curve(CurveBasis::linear, {p, {1, 0, 0, -1}}), ContainsSubstring("negative"));
    CHECK_THROWS_WITH(curve(CurveBasis::linear, {p, {1e19f, 0, 0, 1}}), ContainsSubstring("1e18"));
    CHECK_THROWS_WITH(curve(CurveBasis::linear, {{0, 0, 0, 0}, {1, 0, 0, 0}}), ContainsSubstring("radii"));
    CHECK_THROWS_AS(Curves({CurveBasis::linear, {p, p}, {1}}), InputError);
}
