// Warped micro-buffers of several receivers at once, each with its own place and its own warp: what each has
// alone.
#include "tests/gathering/micro_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

TEST_CASE("receivers that are rendered together have the texels that each has alone",
          "[micro_buffers][brdf_warp][sizes]") {
    const PointHierarchy hierarchy(sphere_of_points(2000));
    const MicroBuffers buffers(hierarchy, {.side = 8});
    const auto receivers = receivers_in_sphere(19, 1.5f, 4);  // not a multiple of any width
    std::vector<BrdfWarp> warps;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        warps.emplace_back(16, [i](const Vec3& w) {
            const Vec3 axis = glm::normalize(Vec3(std::cos(float(i)), std::sin(float(i)), 1.0f));
            return Rgb(0.1f + std::pow(std::fmax(0.0f, glm::dot(w, axis)), 10.0f));
        });
    const std::size_t each = buffers.texels_each();
    std::vector<MicroTexel> together(receivers.size() * each), alone(each);
    const auto check = [&](const auto& render_one) {
        std::size_t different = 0, same_as_first = 0;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            render_one(i);
            for (std::size_t k = 0; k < each; ++k) {
                different += alone[k].hit != together[i * each + k].hit ||
                             alone[k].distance != together[i * each + k].distance;
                same_as_first += i > 0 && alone[k].hit == together[k].hit;
            }
        }
        CHECK(different == 0);
        CHECK(same_as_first < receivers.size() * each / 4);  // they differ from one another
    };
    buffers.render_warped(receivers, warps, together);
    check([&](std::size_t i) {
        buffers.render_warped(std::span(&receivers[i], 1), std::span(&warps[i], 1), alone);
    });
    buffers.render(receivers, together);
    check([&](std::size_t i) { buffers.render(std::span(&receivers[i], 1), alone); });
}
