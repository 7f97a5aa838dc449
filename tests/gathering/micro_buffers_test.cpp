// Micro-buffers against closed forms.
#include "gathering/micro_buffers/micro_buffers.h"
#include "core/geometry/analytic_shapes.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/gathering/bundle_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

TEST_CASE("inside a closed sphere of radiance 1 a micro-buffer gathers exactly 1", "[micro_buffers]") {
    const std::vector<std::shared_ptr<Shape>> shapes = {make_sphere(Vec3d(1, 2, 3), 2.0, Transform(), true)};
    const SurfaceTriangles sphere = surface_triangles(shapes, {.chord_error = 1e-3f});
    const Surfels surfels = blue_noise_surfels(sphere, 5000);
    REQUIRE(surfels.size() == 5000);
    const PointHierarchy hierarchy(surfels);
    const NodeRadiance radiance(hierarchy, std::vector<Rgb>(5000, Rgb(1.0f)));
    for (const HemisphereMap map : {HemisphereMap::cosine, HemisphereMap::equal_area})
        for (const std::uint32_t side : {1u, 8u, 16u, 24u}) {
            const MicroBuffers buffers(hierarchy, {.side = side, .map = map});
            std::vector<MicroReceiver> receivers;
            Rng rng(1);
            for (int i = 0; i < 100; ++i) {
                const Vec3 n = square_to_sphere(rng.next_vec2());
                receivers.push_back(
                    {Vec3(1, 2, 3) + 1.99f * rng.next_float() * square_to_sphere(rng.next_vec2()), Frame(n)});
            }
            std::vector<Rgb> irradiance(receivers.size());
            gather_irradiance(buffers, radiance, receivers, irradiance);
            for (const Rgb& e : irradiance) CHECK(std::fabs(e.x * inv_pi - 1.0f) < 1e-6f);
        }
}
