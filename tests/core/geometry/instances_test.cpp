// Instances: the same hits as copies of their meshes, in every kind of query, under every invertible map;
// rays that leave them; areas and samples; and memory that does not grow with their number.
#include "core/geometry/instances.h"

#include "core/geometry/curves.h"
#include "core/objects/error.h"
#include "tests/core/geometry/meshes.h"
#include "tests/support/catch.h"

using namespace mote::tests;

namespace {

std::shared_ptr<ShapeGroup> group_of(std::vector<std::shared_ptr<Shape>> shapes) {
    auto group = std::make_shared<ShapeGroup>();
    group->shapes = std::move(shapes);
    return group;
}

Transform shear(double amount) {
    glm::dmat4 m(1.0);
    m[1][0] = amount, m[2][1] = 0.5 * amount;
    return Transform(m);
}

/// Turned, mirrored, stretched, sheared; of any scale, anywhere.
struct Map {
    const char* name;
    Transform place;
};
std::vector<Map> maps(double scale) {
    const Transform size = scaling(scale, scale, scale), turned = rotation(40, {1, 2, 3});
    const Transform away = translation(3 * scale, -scale, 2 * scale);
    return {{"turned", away * turned * size},
            {"mirrored", away * turned * size * scaling(-1, 1, 1)},
            {"stretched", away * turned * size * scaling(1, 3, 0.4)},
            {"sheared and mirrored", away * turned * size * shear(0.8) * scaling(1, -2, 1)}};
}

/// A ball with normals and texture coordinates, and a cube: what transform_mesh() can copy.
MeshData ball_data() {
    MeshData data = sphere_mesh({0.2f, 0, 0}, 0.9f, 24, 12);
    for (const Vec3& p : data.positions) data.uvs.emplace_back(0.5f * p.x + 0.3f * p.y, p.z);
    return data;
}

std::shared_ptr<TriangleMesh> copy_of(MeshData data, const Transform& place) {
    transform_mesh(data, place);
    return mesh(std::move(data));
}

float largest(const Vec3& v) { return max_component(glm::abs(v)); }

}  // namespace

TEST_CASE("an instance is hit where a copy of its mesh is", "[geometry][instances]") {
    const double scale = GENERATE(1e-4, 1.0, 1e4);
    const auto original = mesh(ball_data());
    original->tangent_matters = true;
    const auto group = group_of({mesh(make_cube()), original});
    for (const auto& [name, place] : maps(scale)) {
        INFO(name << ", scale " << scale);
        const auto placed = place_group(group, place);
        const auto copy = copy_of(ball_data(), place), cube = copy_of(make_cube(), place);
        copy->tangent_matters = true;
        const std::shared_ptr<Shape> copies[] = {cube, copy};
        const RayTracer by_instance(placed), by_copy(copies);
        const Bounds3 box = copy->bounds();
        CHECK(glm::all(glm::lessThanEqual(placed[1]->bounds().lower, box.lower)));
        CHECK(glm::all(glm::greaterThanEqual(placed[1]->bounds().upper, box.upper)));
        Rng rng(1);
        int different = 0, hits = 0;
        float position = 0, normal = 0, shading = 0, tangent = 0, uv = 0;
        for (int i = 0; i < 3000; ++i) {
            const Vec3 from = box.center() + 3.0f * box.radius() * square_to_sphere(rng.next_vec2());
            const Vec3 to = box.center() + 0.6f * box.radius() * square_to_sphere(rng.next_vec2());
            const auto a = by_instance.closest(ray(from, to - from)),
                       b = by_copy.closest(ray(from, to - from));
            different += a.has_value() != b.has_value();
            if (!a || !b) continue;
            const std::size_t member = b->shape == copies[0].get() ? 0 : 1;
            if (a->shape != placed[member].get() || a->primitive != b->primitive) {
                ++different;  // near an edge
                continue;
            }
            ++hits;
            position = std::max(position, largest(a->position - b->position) / box.radius());
            normal = std::max(normal, largest(a->geometric_normal - b->geometric_normal));
            shading = std::max(shading, largest(a->shading.n - b->shading.n));
            tangent = std::max(tangent, largest(a->shading.s - b->shading.s) * float(member));
            uv = std::max(uv, glm::length(Vec2(a->uv) - Vec2(b->uv)));
            different += by_instance.occluded(ray(from, to - from)) != true;
        }
        CHECK(different <= 6);
        CHECK(hits > 1000);
        // Single precision, and rays whose grazing hits move by more.
        CHECK(position < 2e-5f);
        CHECK(normal < 1e-5f);
        CHECK(shading < 2e-5f);
        CHECK(tangent < 1e-3f);  // of u along the faceted ball, not of its first axis
        CHECK(uv < 2e-4f);
    }
}

TEST_CASE("an instanced normal is that of the surface, not of the map", "[geometry][instances][planted]") {
    // The slope of a roof that is stretched: a normal transformed as a direction would be far off.
    const auto roof = mesh(one_triangle({-1, 0, 0}, {1, 0, 0}, {0, 1, 1}));
    const Transform place = scaling(1, 1, 4);
    const auto placed = place_group(group_of({roof}), place);
    const RayTracer tracer(placed);
    const auto hit = tracer.closest(ray({0, 0.2f, 10}, {0, 0, -1}));
    REQUIRE(hit);
    CHECK(hit->geometric_normal.z == Approx(1.0 / std::sqrt(17.0)));
    const Vec3d wrong = glm::normalize(place.vector(Vec3d(0, -1, 1) / std::sqrt(2.0)));
    CHECK(std::fabs(float(wrong.z) - hit->geometric_normal.z) > 0.5f);
}

TEST_CASE("packets, streams and all hits see instances as single rays do", "[geometry][instances]") {
    const auto group = group_of({mesh(ball_data()), make_sphere({0, 0, 1.2}, 0.5, Transform(), false),
                                 make_cylinder({0, 0, -2}, {0, 0.3, -1}, 0.3, Transform(), false)});
    std::vector<std::shared_ptr<Shape>> shapes = {mesh(make_rectangle())};
    Rng rng(7);
    const bool many = GENERATE(false, true);  // above 8000 primitives the rays are traced as a stream
    for (int i = 0; i < (many ? 40 : 8); ++i) {
        const Vec3d at(6.0f * (square_to_sphere(rng.next_vec2()) * rng.next_float()));
        const auto more = place_group(group, translation(at.x, at.y, at.z) *
                                                 rotation(360.0 * double(rng.next_float()), {1, 1, 0}) *
                                                 scaling(i % 2 == 0 ? -1 : 1, 0.7, 1.3));
        shapes.insert(shapes.end(), more.begin(), more.end());
    }
    const RayTracer tracer(shapes);
    std::vector<ShadowPacket> packets(500);
    for (ShadowPacket& packet : packets) {
        packet.clear();
        for (int lane = 0; lane < ShadowPacket::width; ++lane) {
            const Vec3 from = 8.0f * square_to_sphere(rng.next_vec2()),
                       d = 8.0f * square_to_sphere(rng.next_vec2()) - from;
            packet.origin_x[lane] = from.x, packet.origin_y[lane] = from.y, packet.origin_z[lane] = from.z;
            packet.direction_x[lane] = d.x, packet.direction_y[lane] = d.y, packet.direction_z[lane] = d.z;
            packet.t_min[lane] = 0.0f, packet.t_max[lane] = 1.0f;
        }
    }
    std::vector<ShadowPacket> streamed = packets;
    tracer.occluded(std::span<ShadowPacket>(streamed));
    int different = 0, hits = 0;
    std::vector<SurfaceHit> along;
    for (std::size_t i = 0; i < packets.size(); ++i) {
        ShadowPacket traced = packets[i];
        tracer.occluded(traced);
        for (int lane = 0; lane < ShadowPacket::width; ++lane) {
            const ShadowPacket& p = packets[i];
            Ray single;
            single.origin = {p.origin_x[lane], p.origin_y[lane], p.origin_z[lane]};
            single.direction = {p.direction_x[lane], p.direction_y[lane], p.direction_z[lane]};
            single.t_max = 1.0f;
            const auto closest = tracer.closest(single);
            tracer.all_hits(single, RayTracer::Group::surfaces, along);
            const bool occluded = tracer.occluded(single);
            hits += occluded;
            different += traced.occluded(lane) != occluded || streamed[i].occluded(lane) != occluded ||
                         closest.has_value() != occluded || along.empty() == occluded;
            if (closest && !along.empty())
                different += along.front().shape != closest->shape || along.front().t != closest->t;
            different +=
                !std::is_sorted(along.begin(), along.end(), [](auto& a, auto& b) { return a.t < b.t; });
        }
    }
    CHECK(different <= 4);  // the last bit of an edge
    CHECK(hits > 500);
}

TEST_CASE("rays leaving an instance never hit it again", "[geometry][instances][offset]") {
    Rng rng(3);
    int wrong = 0, leaks = 0, rays = 0;
    for (int i = 0; i < 240; ++i) {
        const double scale = std::pow(10.0, 8.0 * double(rng.next_float()) - 4.0);
        const double away = scale * std::pow(10.0, 2.0 * double(rng.next_float()));
        const Vec3d at = away * Vec3d(square_to_sphere(rng.next_vec2()));
        const auto stretch = [&] { return std::pow(10.0, 2.0 * double(rng.next_float()) - 1.0); };
        const Transform place =
            translation(at.x, at.y, at.z) *
            rotation(360.0 * double(rng.next_float()), Vec3d(square_to_sphere(rng.next_vec2()))) *
            scaling(scale * stretch(), -scale * stretch(), scale * stretch()) *
            rotation(360.0 * double(rng.next_float()), {1, 2, -1});
        std::shared_ptr<Shape> shape;
        if (i % 3 == 0)
            shape = mesh(one_triangle(square_to_sphere(rng.next_vec2()), square_to_sphere(rng.next_vec2()),
                                      3.0f * square_to_sphere(rng.next_vec2())));
        else if (i % 3 == 1)
            shape = make_sphere({0.3, 0, 0}, 1.0, Transform(), false);
        else
            shape = make_disk(translation(5, 0, 0), false);
        const auto placed = place_group(group_of({shape}), place);
        const RayTracer tracer(placed);
        for (int k = 0; k < 200; ++k) {
            const ShapeSample s = placed[0]->sample_area(rng.next_vec2());
            Vec3 direction = square_to_sphere(rng.next_vec2());
            if (i % 3 == 1 && glm::dot(direction, s.normal) < 0.0f) direction = -direction;
            const Ray leaving = ray(offset_origin(s.position, s.normal, s.error, direction), direction);
            wrong += tracer.occluded(leaving) || tracer.closest(leaving).has_value();
            // From the other side of the surface it is met.
            const Vec3 behind = offset_origin(s.position, s.normal, s.error, -s.normal);
            leaks += i % 3 != 1 && !tracer.occluded(ray(behind, s.normal));
            ++rays;
        }
    }
    CHECK(rays == 48000);
    CHECK(wrong == 0);
    CHECK(leaks <= 20);  // samples on the very border
}

TEST_CASE("the area of an instance, and points sampled on it", "[geometry][instances][sampling]") {
    const auto check = [](const Shape& shape, double expected, double tolerance) {
        CHECK(double(shape.area()) == Approx(expected).epsilon(tolerance));
        // The mean of 1 / pdf_area is the area, whatever the density.
        Rng rng(5);
        const int n = 20000;
        double sum = 0.0, square = 0.0;
        for (int i = 0; i < n; ++i) {
            const ShapeSample s = shape.sample_area(rng.next_vec2());
            sum += 1.0 / double(s.pdf_area), square += 1.0 / (double(s.pdf_area) * double(s.pdf_area));
            if (i >= 200) continue;
            // Seen from a point, the density per solid angle is that of the sample.
            const Vec3 p = s.position + 0.7f * s.normal + Vec3(0.3f, 0.1f, -0.2f);
            const Vec3 to_light = s.position - p;
            SurfaceHit hit;
            hit.position = s.position, hit.geometric_normal = s.normal;
            const double d2 = double(glm::dot(to_light, to_light));
            const double cosine = std::fabs(double(glm::dot(s.normal, glm::normalize(to_light))));
            CHECK(double(shape.pdf_visible(p, glm::normalize(to_light), hit)) ==
                  Approx(double(s.pdf_area) * d2 / cosine).epsilon(2e-3));
        }
        const double mean = sum / n, sigma = std::sqrt(std::max(0.0, square / n - mean * mean) / n);
        CHECK(std::fabs(mean - expected) <= 4.5 * sigma + 1e-4 * expected);
    };
    for (const auto& [name, place] : maps(1.0)) {
        INFO(name);
        const auto placed = place_group(group_of({mesh(ball_data())}), place);
        check(*placed[0], double(copy_of(ball_data(), place)->area()), 1e-5);
    }
    // An ellipsoid of half axes 1, 1, 1/2: 2 pi (1 + (1 - e^2) / e atanh e), e^2 = 3/4.
    const double e = std::sqrt(0.75), oblate = 2.0 * double(pi) * (1.0 + 0.25 / e * std::atanh(e));
    const auto flat =
        place_group(group_of({make_sphere({0, 0, 0}, 1.0, Transform(), false)}), scaling(1, 1, 0.5));
    check(*flat[0], oblate, 1e-3);
}

TEST_CASE("a thousand instances share their mesh", "[geometry][instances][memory]") {
    const auto tracer_bytes = [](int instances) {
        const auto group = group_of({mesh(sphere_mesh({0, 0, 0}, 1.0f, 128, 64))});
        std::vector<std::shared_ptr<Shape>> shapes;
        for (int i = 0; i < instances; ++i) {
            const auto more = place_group(group, translation(3.0 * i, 0, 0));
            shapes.insert(shapes.end(), more.begin(), more.end());
        }
        const RayTracer tracer(shapes);
        for (int i = 0; i < instances; i += 97)
            CHECK(tracer.closest(ray({3.0f * float(i), 0.1f, 5}, {0, 0, -1}))->shape ==
                  shapes[std::size_t(i)].get());
        // The mesh itself has three users: the group and us, whatever the number of instances.
        CHECK(group->shapes[0].use_count() == 1);
        return tracer.memory_bytes();
    };
    const std::size_t one = tracer_bytes(1), thousand = tracer_bytes(1000);
    INFO(one << " bytes for one, " << thousand << " for a thousand");
    CHECK(one > 1000000);                 // 16,000 triangles
    CHECK(thousand < 2.0 * double(one));  // and not a thousand times as much
}

TEST_CASE("instances that cannot be are refused", "[geometry][instances]") {
    const auto group = group_of({mesh(make_cube())});
    CHECK_THROWS_WITH(place_group(group, scaling(1, 0, 1)), ContainsSubstring("singular"));
    CHECK_THROWS_WITH(place_group(group, scaling(1, std::nan(""), 1)), ContainsSubstring("not finite"));
    CHECK_THROWS_WITH(place_group(group, translation(1e19, 0, 0)), ContainsSubstring("1e18"));
    // Determinants that single precision does not hold, and rows that it cannot distinguish.
    const auto singular = ContainsSubstring("singular in single precision");
    for (const double s : {1e-20, 1e-13, 1e13, 1e17})
        CHECK_THROWS_WITH(place_group(group, scaling(s, s, s)), singular);
    glm::dmat4 sheared(1.0);
    sheared[0] = {1.0, 1.0, 0.0, 0.0}, sheared[1] = {1.0, 1.0 + 1e-7, 0.0, 0.0};
    CHECK_THROWS_WITH(place_group(group, rotation(40, {1, 2, 3}) * Transform(sheared)), singular);
    // Those that it does hold stay, turned and uneven ones too.
    for (const double s : {1e-12, 1e-6, 1e6, 1e12}) CHECK_NOTHROW(place_group(group, scaling(s, s, s)));
    CHECK_NOTHROW(place_group(group, rotation(40, {1, 2, 3}) * scaling(1e11, 1, 1)));
    CHECK_NOTHROW(place_group(group, scaling(1e-11, 1, 1) * rotation(40, {1, 2, 3})));
}

TEST_CASE("rays that an instance's space cannot hold meet nothing, and do not end the program",
          "[geometry][instances]") {
    const auto cubes = group_of({mesh(make_cube())});
    CHECK_THROWS_WITH(RayTracer(place_group(cubes, scaling(1e-20, 1, 1))),
                      ContainsSubstring("too small for its shapegroup"));
    const auto thin = place_group(cubes, scaling(1e-10, 1, 1));
    const RayTracer tracer(thin);
    CHECK(tracer.closest(ray({0, 0.2f, 5}, {0, 0, -1})));
    CHECK_FALSE(tracer.closest(ray({0, 0.2f, 1e15f}, {0, 0, -1})));
}

TEST_CASE("instances are hit in scenes of any size", "[geometry][instances]") {
    for (const double s : {0x1p-33, 0x1p-20, 0x1p20, 0x1p33}) {
        const auto placed = place_group(group_of({mesh(make_cube())}), scaling(s, s, s));
        const RayTracer tracer(placed);
        const auto hit = tracer.closest(ray({0, 0.2f * float(s), 5.0f * float(s)}, {0, 0, -1}));
        REQUIRE(hit);
        CHECK(double(hit->t) == Approx(4.0 * s));
        CHECK(double(hit->position.y) == Approx(0.2 * s));
    }
}
