// Every disc that a ray passes near enough, against testing all of them.
#include "core/geometry/ray_facing_discs.h"

#include <algorithm>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

std::vector<RayFacingDiscs::Disc> random_discs(std::size_t count, float scale) {
    Rng rng(count);
    std::vector<RayFacingDiscs::Disc> discs(count);
    for (auto& d : discs) {
        d.center = scale * Vec3(rng.next_float(), rng.next_float(), rng.next_float());
        d.radius = scale * 0.2f * sqr(rng.next_float()) + 1e-4f * scale;
    }
    return discs;
}

}  // namespace

TEST_CASE("A ray meets the discs whose centres it passes within their radius", "[discs]") {
    for (const float scale : {1.0f, 1e-3f, 1e3f}) {
        const auto discs = random_discs(3000, scale);
        RayFacingDiscs facing;
        facing.build(discs);
        Rng rng(5);
        std::vector<RayFacingDiscs::Hit> hits;
        std::size_t met = 0, expected = 0, doubtful = 0;
        for (int i = 0; i < 300; ++i) {
            // Origins among the discs, so that many of them are nearer than their own radius.
            Ray ray{scale * Vec3(rng.next_float(), rng.next_float(), rng.next_float()),
                    square_to_sphere({rng.next_float(), rng.next_float()})};
            ray.t_max = i % 3 == 0 ? 0.4f * scale : infinity;
            facing.hits(ray, hits);
            REQUIRE(std::is_sorted(hits.begin(), hits.end(), [](auto& a, auto& b) { return a.t < b.t; }));
            std::vector<bool> hit(discs.size(), false);
            for (const auto& h : hits) {
                REQUIRE_FALSE(hit[h.index]);
                hit[h.index] = true;
                REQUIRE((h.t >= ray.t_min && h.t <= ray.t_max));
            }
            for (std::size_t d = 0; d < discs.size(); ++d) {
                const Vec3d to = Vec3d(discs[d].center) - Vec3d(ray.origin), w(ray.direction);
                const double t = glm::dot(to, w), distance = glm::length(to - t * w);
                const double slack = 1e-5 * double(scale);
                const bool sure_in = distance < discs[d].radius - slack && t > slack && t < ray.t_max - slack;
                const bool sure_out =
                    distance > discs[d].radius + slack || t < -slack || t > ray.t_max + slack;
                if (!sure_in && !sure_out) {
                    ++doubtful;
                    continue;
                }
                REQUIRE(hit[d] == sure_in);
                met += hit[d], expected += sure_in;
            }
        }
        CHECK(met == expected);
        CHECK(met > 1000);
        CHECK(doubtful < 300);
    }
}

TEST_CASE("No discs, and rays that are no rays, give no hits", "[discs]") {
    RayFacingDiscs facing;
    std::vector<RayFacingDiscs::Hit> hits(3);
    facing.hits(Ray{}, hits);
    CHECK(hits.empty());
    facing.build({});
    facing.hits(Ray{}, hits);
    CHECK(hits.empty());
    facing.build(random_discs(10, 1.0f));
    facing.hits(Ray{Vec3(std::nanf(""))}, hits);
    CHECK(hits.empty());
    CHECK(facing.memory_bytes() >= 160);
}
