// Imperfect bundles that are looked up: a point sees along a line what a ray finds, but for holes between
// discs and for what lies between two rays of the grid.
#include "gathering/eye_bundles/imperfect_links.h"

#include "core/objects/error.h"
#include "gathering/ray_bundles/bundle_directions.h"
#include "tests/gathering/eye_bundle_rooms.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using namespace mote::tests;

namespace {

struct Agreement {
    int queries = 0, known = 0, same = 0;
};

/// Agreement of the grid with traced rays at points that an eye sees, along lines and against them: how often
/// the grid holds a link, and how often it ends where a ray does, within two spacings.
Agreement agreement(const ImperfectLinkSettings& settings, bool opposite = false) {
    const auto scene = scene_from(corner_room(matt, ball_lamp));
    const ImperfectLinks links(scene->shapes(), settings);
    Agreement sum;
    Rng rng(4);
    for (std::uint64_t number = 0; number < 20; ++number) {
        const Vec3 direction = bundle_sample(3, number).direction;
        const RayBundle bundle = links.bundle(direction, number, 1, {});
        for (int k = 0; k < 50; ++k) {
            const Vec3 eye(-0.8f, 0.8f, 0.8f);
            const Vec3 target(0.9f, -0.9f, 1.2f * rng.next_float() - 0.9f);
            const ScatteringVertex x = vertex_on(*scene, eye, target - 0.5f * rng.next_float() - eye);
            const bool leaves =
                glm::dot(x.hit.geometric_normal, direction) * glm::dot(x.hit.geometric_normal, x.wo) > 0.0f;
            const Vec3 w = leaves ? direction : -direction;
            ++sum.queries;
            const auto end = links.next(bundle, x, opposite ? -w : w);
            if (!end) continue;
            ++sum.known;
            const auto hit = scene->first_hit({x.ray_origin(w), w});
            const bool both = hit && end->hit;
            sum.same += both ? glm::distance(hit->position, end->hit->position) < 2.0f * 3.5f / 256.0f * 4.0f
                             : bool(hit) == bool(end->hit);
        }
    }
    return sum;
}

}  // namespace

TEST_CASE("imperfect bundles find what a ray finds, more often with more points", "[bundles][kept]") {
    const Agreement few = agreement({.points = 1024, .splat_size = 1.0f});
    const Agreement many = agreement({.points = 65536, .splat_size = 1.0f});
    const Agreement wrong =
        agreement({.points = 65536, .splat_size = 1.0f}, true);  // planted: the other side
    CAPTURE(few.known, few.same, many.known, many.same, wrong.same, many.queries);
    CHECK(many.same > few.same);
    CHECK(many.known > 0.5 * many.queries);
    CHECK(many.same > 0.8 * many.known);
    CHECK(wrong.same < 0.6 * wrong.queries);
}

TEST_CASE("kept bundles share their budget", "[bundles][kept]") {
    const auto scene = scene_from(corner_room(matt, ball_lamp));
    ImperfectLinkSettings settings;
    settings.memory_budget = std::size_t(8) << 20;
    const ImperfectLinks links(scene->shapes(), settings);
    CHECK_NOTHROW(links.bundle({0, 0, 1}, 0, 1, {}));
    CHECK_THROWS_AS(links.bundle({0, 0, 1}, 0, 10000, {}), InputError);
}
