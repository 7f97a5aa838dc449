// Triangle meshes: what is refused and repaired, orientation, normals, sampling, closedness.
#include "core/geometry/triangle_mesh.h"

#include "core/geometry/mesh_edits.h"
#include "core/objects/error.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"
#include "tests/support/chi2.h"

using namespace mote::tests;

TEST_CASE("meshes that cannot be traced are refused", "[geometry][mesh]") {
    MeshData bad = make_cube();
    bad.positions[5].y = std::nanf("");
    CHECK_THROWS_WITH(TriangleMesh(bad), ContainsSubstring("vertex 5") && ContainsSubstring("not finite"));
    bad.positions[5].y = infinity;
    CHECK_THROWS_AS(TriangleMesh(bad), InputError);
    bad.positions[5].y = 2e18f;
    CHECK_THROWS_WITH(TriangleMesh(bad), ContainsSubstring("1e18"));
    bad = make_cube();
    bad.triangles[3][1] = 24;
    CHECK_THROWS_WITH(TriangleMesh(bad), ContainsSubstring("triangle 3") && ContainsSubstring("24"));
    CHECK_THROWS_AS(TriangleMesh(MeshData{}), InputError);
    CHECK_THROWS_AS(TriangleMesh(one_triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2})), InputError);
    bad = make_cube();
    bad.uvs.pop_back();
    CHECK_THROWS_AS(TriangleMesh(bad), InputError);
}

TEST_CASE("triangles without area are dropped and counted", "[geometry][mesh]") {
    MeshData data = make_cube();
    data.triangles.push_back({0, 0, 1});
    data.triangles.insert(data.triangles.begin(), {7, 7, 7});
    data.positions.insert(data.positions.end(), {{0, 0, 0}, {0.1f, 0.2f, 0.3f}, {0.2f, 0.4f, 0.6f}});
    data.normals.resize(27), data.uvs.resize(27);
    data.triangles.push_back({24, 25, 26});
    const TriangleMesh cube(data);
    CHECK(cube.primitive_count() == 12);
    REQUIRE(cube.notes.size() == 1);
    CHECK(cube.notes[0] == "3 degenerate triangles dropped");
    CHECK(cube.area() == Approx(24.0));
}

TEST_CASE("closed means: no border, and one idea of outside", "[geometry][mesh]") {
    CHECK(TriangleMesh(make_cube()).closed());  // 24 vertices at 8 positions
    CHECK_FALSE(TriangleMesh(make_rectangle()).closed());
    MeshData open = make_cube();
    open.triangles.pop_back();
    CHECK_FALSE(TriangleMesh(open).closed());
    MeshData turned = make_cube();
    std::swap(turned.triangles[0][0], turned.triangles[0][1]);
    CHECK_FALSE(TriangleMesh(turned).closed());
    // Two cubes that share an edge: four triangles meet there, and inside is well defined.
    MeshData pair = make_cube();
    for (std::uint32_t i = 0; i < 24; ++i) {
        pair.positions.push_back(pair.positions[i] + Vec3(2, 2, 0));
        pair.normals.push_back(pair.normals[i]), pair.uvs.push_back(pair.uvs[i]);
    }
    for (std::size_t i = 0; i < 12; ++i) {
        const auto t = pair.triangles[i];
        pair.triangles.push_back({t[0] + 24, t[1] + 24, t[2] + 24});
    }
    CHECK(TriangleMesh(pair).closed());
    // Positive and negative zero are one position.
    MeshData zero = make_cube();
    for (Vec3& p : zero.positions) p = 0.5f * p + Vec3(0.5f);
    for (std::size_t i = 0; i < zero.positions.size(); i += 2)
        for (int axis = 0; axis < 3; ++axis)
            if (zero.positions[i][axis] == 0.0f) zero.positions[i][axis] = -0.0f;
    CHECK(TriangleMesh(zero).closed());
}

TEST_CASE("transforms keep the outside out, mirrored or not", "[geometry][mesh]") {
    const Transform transforms[] = {Transform(), rotation(70, {1, 2, 3}), scaling(-1, 1, 1),
                                    scaling(-2, -3, -0.5),
                                    translation(5, 6, 7) * rotation(200, {0, 1, 1}) * scaling(1, -2, 3)};
    for (const Transform& t : transforms) {
        MeshData data = make_cube();
        transform_mesh(data, t);
        const TriangleMesh cube(data);
        CHECK(cube.closed());
        const Vec3 center(t.point({0, 0, 0}));
        for (std::uint32_t i = 0; i < 12; ++i) {
            SurfaceHit hit;
            cube.fill_hit(i, 0.3f, 0.3f, hit);
            CHECK(glm::dot(hit.geometric_normal, hit.position - center) > 0.0f);
            CHECK(glm::dot(hit.shading.n, hit.geometric_normal) > 0.999f);
        }
        flip_orientation(data);
        SurfaceHit hit;
        TriangleMesh(data).fill_hit(0, 0.3f, 0.3f, hit);
        CHECK(glm::dot(hit.geometric_normal, hit.position - center) < 0.0f);
    }
}

// Stretched unevenly, a normal does not turn with the surface's vectors.
TEST_CASE("given normals stay at right angles to the surface under every transform", "[geometry][mesh]") {
    const Transform transforms[] = {scaling(1, 4, 0.5), scaling(-1, 1, 3), scaling(-2, -3, -0.5),
                                    translation(5, 6, 7) * rotation(200, {0, 1, 1}) * scaling(1, -2, 3)};
    for (const Transform& t : transforms) {
        MeshData data = one_triangle({0, 0, 0}, {1, 0, 0.5f}, {0.2f, 1, -0.3f});
        SurfaceHit hit;
        TriangleMesh(data).fill_hit(0, 0.3f, 0.3f, hit);
        data.normals.assign(3, hit.geometric_normal);
        transform_mesh(data, t);
        TriangleMesh(data).fill_hit(0, 0.3f, 0.3f, hit);
        for (const Vec3& n : data.normals) {
            CHECK(glm::length(n) == Approx(1.0f));
            CHECK(std::fabs(glm::dot(n, hit.geometric_normal)) == Approx(1.0f).epsilon(1e-5));
        }
    }
}

TEST_CASE("shading normals follow the vertices on the face's side", "[geometry][mesh]") {
    MeshData data = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    data.normals = {glm::normalize(Vec3(-1, 0, 1)), glm::normalize(Vec3(1, 0, 1)), {0, 0, 1}};
    SurfaceHit hit;
    TriangleMesh(data).fill_hit(0, 0.25f, 0.0f, hit);
    CHECK(hit.shading.n.x < -0.1f);
    CHECK(glm::length(hit.shading.n) == Approx(1.0));
    for (Vec3& n : data.normals) n = -n;
    TriangleMesh(data).fill_hit(0, 0.25f, 0.0f, hit);
    CHECK(hit.shading.n.z > 0.0f);
    CHECK(hit.shading.n.x < -0.1f);
    data.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 0, 0}};  // cancel half-way
    TriangleMesh(data).fill_hit(0, 0.5f, 0.0f, hit);
    CHECK(hit.shading.n == hit.geometric_normal);
    CHECK(hit.uv == Vec2(0.5f, 0.0f));  // no texture coordinates: barycentric
}

TEST_CASE("computed normals of a sphere mesh point outwards", "[geometry][mesh]") {
    MeshData data = sphere_mesh({1, 2, 3}, 2.0f, 40, 20);
    compute_vertex_normals(data);
    float least = 1.0f;
    for (std::size_t i = 0; i < data.positions.size(); ++i)
        least = std::min(least, glm::dot(data.normals[i], (data.positions[i] - Vec3(1, 2, 3)) / 2.0f));
    CHECK(least > 0.999f);
}

TEST_CASE("rectangle and cube are Mitsuba's", "[geometry][mesh]") {
    const TriangleMesh square(make_rectangle());
    CHECK(square.area() == Approx(4.0));
    CHECK(square.bounds().lower == Vec3(-1, -1, 0));
    Rng rng(8);
    for (int i = 0; i < 100; ++i) {
        const ShapeSample s = square.sample_area(rng.next_vec2());
        CHECK(s.normal == Vec3(0, 0, 1));
        CHECK(s.uv.x == Approx(0.5f * (s.position.x + 1.0f)).margin(1e-6));
        CHECK(s.uv.y == Approx(0.5f * (s.position.y + 1.0f)).margin(1e-6));
    }
    const TriangleMesh cube(make_cube());
    CHECK(cube.area() == Approx(24.0));
    // Every face carries the whole texture.
    const MeshData data = make_cube();
    for (std::size_t face = 0; face < 6; ++face) {
        Vec2 sum(0.0f);
        for (std::size_t i = 0; i < 4; ++i) sum += data.uvs[4 * face + i];
        CHECK(sum == Vec2(2.0f, 2.0f));
    }
}

TEST_CASE("points on a mesh are uniform by area", "[geometry][mesh][sampling]") {
    // A rectangle of unequal triangles: counts in a grid follow chi square.
    MeshData data;
    data.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3f, 0.1f, 0}};
    data.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    const TriangleMesh square(data);
    CHECK(square.area() == Approx(1.0));
    constexpr int cells = 10, samples = 200000;
    std::vector<int> counts(cells * cells, 0);
    Rng rng(9);
    for (int i = 0; i < samples; ++i) {
        const ShapeSample s = square.sample_area(rng.next_vec2());
        CHECK(s.pdf_area == Approx(1.0));
        const int x = std::min(cells - 1, int(s.position.x * cells));
        ++counts[std::size_t(std::min(cells - 1, int(s.position.y * cells)) * cells + x)];
    }
    double statistic = 0.0;
    const double expected = double(samples) / counts.size();
    for (const int c : counts) statistic += (c - expected) * (c - expected) / expected;
    CHECK(chi2_survival(statistic, cells * cells - 1) > 0.001);
}

TEST_CASE("tiny and huge meshes have areas and samples", "[geometry][mesh]") {
    for (const float size : {1e-15f, 1e-8f, 1e8f, 1e15f}) {
        const auto triangle = mesh(one_triangle({0, 0, 0}, {size, 0, 0}, {0, size, 0}));
        CHECK(triangle->area() == Approx(0.5 * double(size) * double(size)));
        const ShapeSample s = triangle->sample_area({0.5f, 0.5f});
        CHECK(is_finite(s.position));
        CHECK(s.normal == Vec3(0, 0, 1));
    }
    CHECK_THROWS_AS(mesh(one_triangle({0, 0, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0})), InputError);
}

TEST_CASE("light sampling of a mesh matches its density", "[geometry][mesh][sampling]") {
    MeshData data = make_rectangle();
    transform_mesh(data, translation(0.5, 0, 2) * rotation(200, {1, 0, 0}));
    const auto light = mesh(std::move(data));
    const std::shared_ptr<Shape> shapes[] = {light};
    const RayTracer tracer(shapes);
    const Vec3 p(0.2f, -0.3f, 0.1f);
    const auto sampler = [&](Rng& rng) -> std::optional<Vec3> {
        float pdf = 0.0f;
        const auto s = light->sample_visible(p, rng.next_vec2(), pdf);
        if (!s) return std::nullopt;
        return glm::normalize(s->position - p);
    };
    const auto density = [&](const Vec3& w) {
        const auto hit = tracer.closest(ray(p, w));
        return hit ? double(light->pdf_visible(p, w, *hit)) : 0.0;
    };
    Chi2Options options;
    options.name = "rectangle light", options.subdivisions = 3, options.cap = 1.0;
    const Chi2Result result = chi2_test(sampler, density, options);
    INFO(result.message);
    CHECK(result.passed);
}
