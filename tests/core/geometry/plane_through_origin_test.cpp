// Surfaces in a coordinate plane have no rounding at all: rays must leave them all the same.
#include "core/geometry/ray_tracer.h"
#include "core/geometry/triangle_mesh.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/core/render/fake_render.h"
#include "tests/support/catch.h"

using namespace mote::core;

TEST_CASE("Rays leave a plane through the origin", "[geometry][self_intersection]") {
    for (int axis = 0; axis < 3; ++axis) {
        MeshData data = make_rectangle();
        for (Vec3& p : data.positions)
            p = axis == 0 ? Vec3(p.z, p.x, p.y) : axis == 1 ? Vec3(p.y, p.z, p.x) : p;
        auto mesh = std::make_shared<TriangleMesh>(data);
        mesh->bsdf = std::make_shared<mote::tests::FakeBsdf>();
        const std::vector<std::shared_ptr<Shape>> shapes{mesh};
        const RayTracer tracer(shapes);
        Rng rng(11);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 direction = square_to_sphere(rng.next_vec2());
            const ShapeSample s = mesh->sample_area(rng.next_vec2());
            const Vec3 origin = offset_origin(s.position, s.normal, s.error, direction);
            REQUIRE_FALSE(tracer.occluded(Ray{origin, direction}));
        }
    }
}
