// From shapes to triangles: nothing that stops light is left out, outsides stay outside.
#include "gathering/ray_bundles/surface_triangles.h"
#include "core/geometry/analytic_shapes.h"
#include "core/geometry/curves.h"
#include "core/geometry/instances.h"
#include "core/geometry/ray_tracer.h"
#include "core/geometry/triangle_mesh.h"
#include "tests/support/catch.h"
#include "tests/support/render_statistics.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

namespace {

double area_of(const SurfaceTriangles& t) {
    double area = 0.0;
    for (const auto& c : t.corners) area += 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
    return area;
}

/// All corners run counter-clockwise about normals that face to the same side.
bool fronts_agree(const SurfaceTriangles& t) {
    for (std::size_t i = 0; i < t.size(); ++i) {
        const Vec3 cross = glm::cross(t.corners[i][1] - t.corners[i][0], t.corners[i][2] - t.corners[i][0]);
        for (const Vec3& n : t.normals[i])
            if (!(glm::dot(n, cross) > 0.0f) || std::fabs(glm::length(n) - 1.0f) > 1e-5f) return false;
    }
    return true;
}

SurfaceTriangles triangles_of(std::shared_ptr<Shape> shape, float chord_error = 1e-3f) {
    const std::vector<std::shared_ptr<Shape>> shapes = {std::move(shape)};
    return surface_triangles(shapes, {.chord_error = chord_error});
}

Transform stretched() {
    glm::dmat4 m = glm::translate(glm::dmat4(1.0), Vec3d(4, -2, 1));
    m = glm::rotate(m, 0.7, glm::normalize(Vec3d(1, 2, 3)));
    return Transform(glm::scale(m, Vec3d(2.0, 0.5, -1.5)));
}

}  // namespace

TEST_CASE("spheres, cylinders and disks are cut finely enough", "[surface_triangles]") {
    for (const bool flipped : {false, true}) {
        const std::shared_ptr<Shape> shapes[] = {
            make_sphere(Vec3d(1, 2, 3), 2.0, Transform(), flipped),
            make_cylinder(Vec3d(0, 0, -1), Vec3d(0.5, 1, 3), 0.4, stretched(), flipped),
            make_disk(stretched(), flipped)};
        for (const auto& shape : shapes) {
            double before = infinity;
            for (const float chord : {1e-2f, 1e-3f, 1e-4f}) {
                const SurfaceTriangles t = triangles_of(shape, chord);
                CHECK(fronts_agree(t));
                const double missing = 1.0 - area_of(t) / double(shape->area());
                // A chord of sagitta s on a circle of radius r is 4 s / (3 r) shorter than its arc, twice
                // over.
                const double extent = double(glm::length(shape->bounds().diagonal()));
                CHECK(missing < 4.0 * double(chord) * extent / 0.4);
                CHECK(missing > -1e-5);
                CHECK(missing < before);
                before = missing;
                for (const auto& corners : t.corners)
                    for (const Vec3& p : corners) CHECK(shape->bounds().contains(p));
            }
        }
    }
}

TEST_CASE("a sphere's triangles close", "[surface_triangles]") {
    const SurfaceTriangles t = triangles_of(make_sphere(Vec3d(0.3, 0, -7), 1.5, Transform(), false), 1e-2f);
    MeshData mesh;
    for (const auto& corners : t.corners) {
        const auto first = std::uint32_t(mesh.positions.size());
        for (const Vec3& p : corners) mesh.positions.push_back(p);
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    CHECK(TriangleMesh(mesh).closed());
}

TEST_CASE("texture coordinates of a cut sphere are its own", "[surface_triangles]") {
    const auto sphere = make_sphere(Vec3d(0.0), 1.0, Transform(), false);
    const SurfaceTriangles t = triangles_of(sphere, 1e-4f);
    for (std::size_t i = 0; i < t.size(); ++i) {
        const Vec3 middle = (t.corners[i][0] + t.corners[i][1] + t.corners[i][2]) / 3.0f;
        if (std::fabs(middle.z) > 0.99f * glm::length(middle)) continue;  // around the poles u is anything
        const Vec2 uv = (t.uvs[i][0] + t.uvs[i][1] + t.uvs[i][2]) / 3.0f;
        SurfaceHit hit;
        sphere->fill_hit(2.0f * middle, -glm::normalize(middle), 1.0f, hit);
        const float u = uv.x - std::floor(uv.x);
        CHECK(std::min(std::fabs(u - hit.uv.x), 1.0f - std::fabs(u - hit.uv.x)) < 0.01f);
        CHECK(std::fabs(uv.y - hit.uv.y) < 0.01f);
    }
}

TEST_CASE("curves become tubes that lie on them", "[surface_triangles]") {
    CurveData data;
    for (int i = 0; i < 12; ++i)
        data.points.push_back({std::cos(0.5f * float(i)), std::sin(0.5f * float(i)), 0.2f * float(i),
                               0.05f + 0.002f * float(i)});
    data.segments = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    auto group = std::make_shared<ShapeGroup>();
    const auto spline = std::make_shared<Curves>(data);
    data.basis = CurveBasis::linear;
    group->shapes = {spline, std::make_shared<Curves>(data)};
    for (const auto& curves : group->shapes) {
        const SurfaceTriangles t = triangles_of(curves, 3e-4f);
        CHECK(fronts_agree(t));
        CHECK(area_of(t) ==
              Approx(curves->area()).epsilon(0.02));  // tapered and bent: Curves::area() is a quadrature
        for (const auto& corners : t.corners)
            for (const Vec3& p : corners) CHECK(curves->bounds().contains(p));
        CHECK(t.primitive.back() == 8);
    }
    const SurfaceTriangles t = triangles_of(spline, 3e-4f);
    const RayTracer tracer(std::vector<std::shared_ptr<Shape>>{spline});
    for (std::size_t i = 0; i < t.size(); i += 97) {
        const Vec3 middle = (t.corners[i][0] + t.corners[i][1] + t.corners[i][2]) / 3.0f;
        const auto hit = tracer.closest({middle + 0.01f * t.normals[i][0], -t.normals[i][0]});
        REQUIRE(hit);
        CHECK(std::fabs(hit->t - 0.01f) < 2e-3f);
        CHECK(glm::dot(hit->geometric_normal, t.normals[i][0]) > 0.9f);
    }
    CHECK(fronts_agree(surface_triangles(place_group(group, stretched()))));
}

TEST_CASE("mirrored instances keep their outside", "[surface_triangles]") {
    auto group = std::make_shared<ShapeGroup>();
    group->shapes = {std::make_shared<TriangleMesh>(make_cube()),
                     make_sphere(Vec3d(0, 0, 3), 1.0, Transform(), false)};
    const auto placed = place_group(group, stretched());
    const SurfaceTriangles t = surface_triangles(placed);
    CHECK(fronts_agree(t));
    double volume = 0.0;  // of what lies behind the fronts
    for (std::size_t i = 0; i < t.size(); ++i) {
        const auto& c = t.corners[i];
        volume += double(glm::dot(c[0], glm::cross(c[1], c[2]))) / 6.0;
    }
    CHECK(volume ==
          Approx(1.5 * (8.0 + 4.18879)).epsilon(5e-3));  // the map's determinant, of a cube and a ball
    CHECK(t.shape.front() == 0);
    CHECK(t.shape.back() == 1);
}

TEST_CASE("what light passes straight is left out", "[surface_triangles]") {
    const auto scene = tests::scene_from(R"(<scene version="3.0.0">
        <shape type="cube"><bsdf type="null"/></shape>
        <shape type="rectangle"><bsdf type="thindielectric"/></shape>
        <shape type="rectangle"><bsdf type="diffuse"/></shape>
        <shape type="rectangle"><bsdf type="dielectric"/></shape>
        <emitter type="point"/><sensor type="perspective"/></scene>)");
    const SurfaceTriangles t = surface_triangles(scene->shapes());
    CHECK(t.shape == std::vector<std::uint32_t>{2, 2, 3, 3});
    CHECK(t.primitive == std::vector<std::uint32_t>{0, 1, 0, 1});
}

TEST_CASE("triangles beyond the budget are refused", "[surface_triangles]") {
    const std::vector<std::shared_ptr<Shape>> shapes = {std::make_shared<TriangleMesh>(make_cube())};
    CHECK(surface_triangles(shapes, {.memory_budget = 12 * 104}).size() == 12);
    CHECK_THROWS_WITH(surface_triangles(shapes, {.memory_budget = 12 * 104 - 1}),
                      ContainsSubstring("the scene's 12 triangles take"));
}
