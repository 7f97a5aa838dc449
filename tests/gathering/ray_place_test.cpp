// Rays of micro-buffers elsewhere than in the middle of their texels.
#include "tests/gathering/micro_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

const Vec2 corners[] = {{0.0f, 0.0f}, {0.97f, 0.02f}, {0.02f, 0.97f}, {0.98f, 0.98f}};

}  // namespace

TEST_CASE("no ray of a closed sphere is missed, wherever in its texel it lies", "[micro_buffers]") {
    const Surfels surfels = sphere_of_points(2000);
    const PointHierarchy hierarchy(surfels);
    const auto receivers = receivers_in_sphere(20, 1.5f, 1);
    const std::vector<BrdfWarp> warps(
        receivers.size(), BrdfWarp(16, [](const Vec3& w) { return Rgb(0.1f + std::pow(w.z, 20.0f)); }));
    for (const Vec2& place : corners) {
        const MicroBuffers buffers(hierarchy, {.side = 9, .place = place});
        std::vector<MicroTexel> texels(receivers.size() * buffers.texels_each());
        buffers.render(receivers, texels);
        CHECK(std::none_of(texels.begin(), texels.end(), [](const MicroTexel& t) { return t.empty(); }));
        buffers.render_warped(receivers, warps, texels);
        CHECK(std::none_of(texels.begin(), texels.end(), [](const MicroTexel& t) { return t.empty(); }));
    }
}

// A lit cap around the normal: rays in the middles of 3 x 3 texels see all of it or nothing, at the same
// elevations whichever way the buffer is turned. The mean over places is the cap's form factor.
TEST_CASE("the mean over places is right where buffers are coarse", "[micro_buffers]") {
    const Surfels surfels = sphere_of_points(20000);
    const PointHierarchy hierarchy(surfels);
    const double sine = 0.5;  // of the cap: sine^2 is its form factor
    std::vector<Rgb> light(surfels.size());
    for (std::size_t i = 0; i < light.size(); ++i)
        light[i] =
            Rgb(surfels.positions[i].z - 3.0f > 2.0f * std::sqrt(1.0f - float(sine * sine)) ? 1.0f : 0.0f);
    const NodeRadiance radiance(hierarchy, light);
    Rng rng(2);
    const auto mean = [&](bool middle) {
        std::vector<MicroReceiver> receivers;
        for (int i = 0; i < 16; ++i) receivers.push_back({Vec3(1, 2, 3), turned_frame(Vec3(0, 0, 1), rng)});
        double sum = 0.0;
        constexpr int n = 12;
        for (int k = 0; k < n * n; ++k) {
            const Vec2 place = (Vec2(float(k % n), float(k / n)) + 0.5f) / float(n);
            const MicroBuffers buffers(hierarchy,
                                       {.side = 3, .place = middle ? Vec2(0.5f) : place, .cut = 0.002f});
            std::vector<Rgb> irradiance(receivers.size());
            gather_irradiance(buffers, radiance, receivers, irradiance);
            for (const Rgb& e : irradiance) sum += double(e.x * inv_pi) / (n * n * 16.0);
            if (middle) return sum * n * n;
        }
        return sum;
    };
    // 36 x 36 places over the hemisphere: the cap's rim passes through a fraction of 4 sine / 36 of them, of
    // which half may fall on the wrong side.
    CHECK(std::fabs(mean(false) - sine * sine) < 2.0 * sine / 36.0);
    CHECK_FALSE(std::fabs(mean(true) - sine * sine) < 2.0 * sine / 36.0);
}
