// Ray bundles at the extremes: right, finite or refused.
#include <numeric>

#include "core/math/random.h"
#include "tests/gathering/form_factors.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::TriangleBuilder;

namespace {

constexpr BundleForm forms[] = {BundleForm::rays, BundleForm::scan};

/// A grid of rays at whole and half metres along z, from 1 m below z = 0.
BundleGrid plain_grid(float spacing, std::uint32_t columns, std::uint32_t rows) {
    BundleGrid grid;
    grid.spacing = spacing, grid.columns = columns, grid.rows = rows;
    grid.origin = Vec3(-0.5f * spacing, -0.5f * spacing, -1.0f);
    return grid;
}

RayBundle trace(const SurfaceTriangles& triangles, const BundleGrid& grid, BundleForm form) {
    return BundleTracer(triangles).trace(grid, {.form = form});
}

bool is_sound(const RayBundle& bundle, std::size_t triangles) {
    if (bundle.first.size() != bundle.grid.rays() + 1 || bundle.first.front() != 0) return false;
    if (bundle.first.back() != bundle.hits.size()) return false;
    for (std::size_t ray = 0; ray < bundle.grid.rays(); ++ray) {
        float before = 0.0f;
        for (const BundleHit& hit : bundle.hits_of(ray)) {
            if (!(hit.distance >= before * (1.0f - 1e-5f)) || !is_finite(hit.distance)) return false;
            if (hit.index() >= triangles || hit.u16 + hit.v16 > 65535) return false;
            before = hit.distance;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("a bundle through nothing is empty", "[ray_bundles]") {
    const SurfaceTriangles nothing;
    const BundleTracer tracer(nothing);
    const BundleGrid none = bundle_grid({0, 0, 1}, nothing.bounds, 0.1f, {0, 0});
    CHECK(none.rays() == 0);
    for (const BundleForm form : forms) {
        CHECK(tracer.trace(none, {.form = form}).first == std::vector<std::uint32_t>{0});
        const RayBundle bundle = tracer.trace(plain_grid(1.0f, 3, 2), {.form = form});
        CHECK(bundle.first == std::vector<std::uint32_t>(7, 0));
        std::size_t links = 0;
        for_each_link(bundle, [&](auto, auto&, auto&) { ++links; });
        CHECK(links == 0);
    }
    // Triangles, but no ray that meets them.
    const SurfaceTriangles far = TriangleBuilder().triangle({90, 90, 0}, {91, 90, 0}, {90, 91, 0}).list();
    for (const BundleForm form : forms) CHECK(trace(far, plain_grid(1.0f, 8, 8), form).hits.empty());
    for (const BundleForm form : forms) CHECK(trace(far, BundleGrid(), form).hits.empty());
}

TEST_CASE("one triangle is hit by its area's worth of rays", "[ray_bundles]") {
    const SurfaceTriangles one = TriangleBuilder().triangle({0, 0, 0}, {8, 0, 0}, {0, 8, 0}).list();
    for (const BundleForm form : forms) {
        const RayBundle bundle = trace(one, plain_grid(0.125f, 80, 80), form);
        CHECK(is_sound(bundle, 1));
        CHECK(std::fabs(double(bundle.hits.size()) * 0.125 * 0.125 - 32.0) < 0.125 * 8.0);
        for (const BundleHit& hit : bundle.hits) CHECK((hit.distance == 1.0f && hit.from_behind()));
    }
}

TEST_CASE("triangles seen on edge are met by no ray", "[ray_bundles]") {
    // A room whose walls stand along the direction, in the very planes of the rays: floor and ceiling remain.
    const SurfaceTriangles room = TriangleBuilder().box({0, 0, 0}, {4, 4, 4}, true).list();
    for (const BundleForm form : forms) {
        const RayBundle bundle = trace(room, plain_grid(0.5f, 9, 9), form);
        CHECK(is_sound(bundle, room.size()));
        CHECK(bundle.hits.size() == 2 * 8 * 8);
        for (const BundleHit& hit : bundle.hits) CHECK(room.shape[hit.index()] >= 4);
    }
    // In the plane of the triangles and at a slant, where rounding decides: what is hit lies where they are.
    Rng rng(5);
    TriangleBuilder fan;
    const Vec3 direction = glm::normalize(Vec3(0.3f, -0.7f, 0.4f)),
               across = glm::normalize(glm::cross(direction, Vec3(0, 0, 1)));
    for (int i = 0; i < 2000; ++i) {
        const auto corner = [&] {
            return (rng.next_float() - 0.5f) * direction + (rng.next_float() - 0.5f) * across;
        };
        const Vec3 a = corner(), b = corner(), c = corner();
        fan.triangle(a, b, c);
    }
    const SurfaceTriangles sheet = fan.list();
    const BundleGrid grid = bundle_grid(direction, sheet.bounds, 0.01f, {0.5f, 0.5f});
    for (const BundleForm form : forms) CHECK(is_sound(trace(sheet, grid, form), sheet.size()));
}

TEST_CASE("triangles without area are met by no ray", "[ray_bundles]") {
    TriangleBuilder builder;
    builder.triangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0})
        .triangle({0, 0, 0}, {4, 4, 0}, {2, 2, 0})
        .triangle({0, 1, 0}, {4, 1, 0}, {4, 1, 0});
    const SurfaceTriangles points = builder.list();
    for (const BundleForm form : forms) CHECK(trace(points, plain_grid(0.25f, 20, 20), form).hits.empty());
}

TEST_CASE("an open scene has rays with any number of hits", "[ray_bundles]") {
    TriangleBuilder leaves;
    for (int i = 0; i < 5; ++i)
        leaves.quad({0, 0, float(i)}, {4, 0, float(i)}, {4, 4, float(i)}, {0, 4, float(i)}, std::uint32_t(i));
    const SurfaceTriangles open = leaves.list();
    for (const BundleForm form : forms) {
        const RayBundle bundle = trace(open, plain_grid(1.0f, 6, 6), form);
        CHECK(bundle.hits.size() == 5 * 16);
        std::size_t fronts = 0, both = 0;
        for_each_link(bundle, [&](auto, auto&, auto&) { ++fronts; });
        for_each_link(
            bundle, [](std::uint32_t) { return true; }, [&](auto, auto&, auto&) { ++both; });
        CHECK(fronts == 0);  // all leaves look up: none sees another's front with its own
        CHECK(both == 4 * 16);
    }
}

TEST_CASE("a million triangles on one ray are all found, in order", "[ray_bundles]") {
    constexpr std::uint32_t count = 1000000;
    TriangleBuilder pile;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float z = float((i * 7919u) % count) * 1e-6f;  // 7919 is prime to a million: each height once
        pile.triangle({0.2f, 0.2f, z}, {0.9f, 0.2f, z}, {0.2f, 0.9f, z});
    }
    const SurfaceTriangles triangles = pile.list();
    BundleGrid grid = plain_grid(1.0f, 2, 2);
    grid.origin = Vec3(-0.1f, -0.1f, -1.0f);  // the first ray at (0.4, 0.4)
    for (const BundleForm form : forms) {
        const RayBundle bundle = trace(triangles, grid, form);
        CHECK(bundle.hits_of(0).size() == count);
        CHECK(bundle.hits.size() == count);
        CHECK(is_sound(bundle, count));
    }
}

TEST_CASE("a million triangles between rays are left out, and one in place is found", "[ray_bundles]") {
    TriangleBuilder dust;
    for (int i = 0; i < 1000000; ++i) {
        const Vec3 p(0.2f + 4e-7f * float(i % 1000), 0.2f + 4e-7f * float(i / 1000), 0.0f);
        dust.triangle(p, p + Vec3(4e-7f, 0, 0), p + Vec3(0, 4e-7f, 0));
    }
    dust.triangle({0.9f, 0.9f, 0}, {1.2f, 0.9f, 0}, {0.9f, 1.2f, 0});
    const SurfaceTriangles triangles = dust.list();
    for (const BundleForm form : forms) {
        const RayBundle bundle = trace(triangles, plain_grid(1.0f, 3, 3), form);
        REQUIRE(bundle.hits.size() == 1);
        CHECK(bundle.hits[0].index() == 1000000);
        CHECK(bundle.hits_of(4).size() == 1);
    }
}

TEST_CASE("surfaces that coincide are all there, fronts and backs in turn", "[ray_bundles]") {
    // A box on a floor, and a leaf of two sides: what touches must not let light between.
    const auto order = [](const SurfaceTriangles& triangles, BundleForm form) {
        const RayBundle bundle = trace(triangles, plain_grid(1.0f, 5, 5), form);
        std::string text;
        for (const BundleHit& hit : bundle.hits_of(2 * 5 + 2)) {
            text += std::to_string(triangles.shape[hit.index()]);
            text += hit.from_behind() ? "b " : "f ";
        }
        return text;
    };
    for (const BundleForm form : forms) {
        // Along +z: into the box through its lower side (4), out through the upper one (5) at once into a
        // slab that lies on it: its lower side is 10.
        TriangleBuilder stack;
        stack.box({0, 0, 0}, {4, 4, 1}, false, 0).box({1, 1, 1}, {3, 3, 2}, false, 6);
        CHECK(order(stack.list(), form) == "4f 5b 10f 11b ");
        TriangleBuilder turned;
        turned.box({1, 1, 1}, {3, 3, 2}, false, 6).box({0, 0, 0}, {4, 4, 1}, false, 0);
        CHECK(order(turned.list(), form) == "4f 5b 10f 11b ");
        // A box on a floor that is open below, which is met first, from behind; and the same through the
        // floor of the storey above.
        TriangleBuilder open;
        open.quad({0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}, 20).box({1, 1, 1}, {3, 3, 2}, false, 6);
        CHECK(order(open.list(), form) == "20b 10f 11b ");
        TriangleBuilder below;
        below.box({1, 1, 1}, {3, 3, 2}, false, 6).quad({0, 0, 1}, {4, 0, 1}, {4, 4, 1}, {0, 4, 1}, 20);
        CHECK(order(below.list(), form) == "20b 10f 11b ");
        // A leaf: its lower side (0) looks down and is met first, then its upper one (1) from behind.
        TriangleBuilder leaf;
        leaf.quad({0, 4, 0}, {4, 4, 0}, {4, 0, 0}, {0, 0, 0}, 0)
            .quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, 1);
        CHECK(order(leaf.list(), form) == "0f 1b ");
        TriangleBuilder flipped;
        flipped.quad({0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, 1)
            .quad({0, 4, 0}, {4, 4, 0}, {4, 0, 0}, {0, 0, 0}, 0);
        CHECK(order(flipped.list(), form) == "0f 1b ");
    }
    TriangleBuilder pile;
    for (int i = 0; i < 100000; ++i) pile.triangle({0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    const SurfaceTriangles same = pile.list();
    for (const BundleForm form : forms)
        CHECK(trace(same, plain_grid(1.0f, 2, 2), form).hits_of(0).size() == 100000);
}

TEST_CASE("what no bundle can be made of is refused", "[ray_bundles]") {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {nan, infinity, -infinity, 2e18f}) {
        SurfaceTriangles triangles = TriangleBuilder().box(Vec3(0.0f), Vec3(1.0f), true).list();
        triangles.corners[7][1].y = bad;
        CHECK_THROWS_WITH(BundleTracer(triangles),
                          ContainsSubstring("triangle 7 (shape 3) has a corner that is not finite"));
    }
    const Bounds3 box{Vec3(0.0f), Vec3(1.0f)};
    CHECK_THROWS_AS(bundle_grid({0, 0, 1}, box, 0.0f, {0, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({0, 0, 1}, box, nan, {0, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({0, 0, 1}, box, -1.0f, {0, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({0, 0, 2}, box, 1.0f, {0, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({nan, 0, 1}, box, 1.0f, {0, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({0, 0, 1}, box, 1.0f, {1.0f, 0}), InputError);
    CHECK_THROWS_AS(bundle_grid({0, 0, 1}, {Vec3(0.0f), Vec3(infinity)}, 1.0f, {0, 0}), InputError);
    CHECK_THROWS_WITH(bundle_grid({0, 0, 1}, box, 1e-7f, {0, 0}),
                      ContainsSubstring("a spacing of") && ContainsSubstring("fits"));
}

TEST_CASE("bundles keep their budget, and say which one would fit", "[ray_bundles]") {
    TriangleBuilder leaves;
    for (int i = 0; i < 50; ++i)
        leaves.quad({0, 0, float(i)}, {4, 0, float(i)}, {4, 4, float(i)}, {0, 4, float(i)});
    const SurfaceTriangles triangles = leaves.list();
    const BundleTracer tracer(triangles);
    const BundleGrid grid = bundle_grid({0, 0, 1}, triangles.bounds, 0.02f, {0.5f, 0.5f});
    for (const BundleForm form : forms) {
        const RayBundle bundle = tracer.trace(grid, {.form = form});
        CHECK(bundle.hits.size() == 50u * 200u * 200u);
        const std::size_t needed = bundle.memory_bytes();
        CHECK(needed < 50u * 200u * 200u * 12u + 210u * 210u * 4u);
        CHECK(tracer.trace(grid, {.form = form, .memory_budget = needed}).hits.size() == bundle.hits.size());
        // A bundle that is too large says which spacing fits, and that one does.
        for (const std::size_t budget : {needed - 1, needed / 7, std::size_t(200000), std::size_t(9000)}) {
            std::string message;
            try {
                tracer.trace(grid, {.form = form, .memory_budget = budget});
            } catch (const InputError& error) {
                message = error.what();
            }
            INFO(message);
            const std::size_t at = message.find("rays fit, ");
            REQUIRE(at != std::string::npos);
            const BundleGrid coarser =
                bundle_grid({0, 0, 1}, triangles.bounds, std::stof(message.substr(at + 10)), {0.5f, 0.5f});
            if (coarser.rays() > 64)
                CHECK_NOTHROW(tracer.trace(coarser, {.form = form, .memory_budget = budget}));
        }
    }
}

TEST_CASE("ten million links take less than 300 MB", "[ray_bundles]") {
    // Closed boxes with two hits a ray each; a tenth of the links is traced.
    TriangleBuilder rooms;
    for (int i = 0; i < 10; ++i) rooms.box({0, 0, 2.0f * float(i)}, {4, 4, 2.0f * float(i) + 1.0f}, true);
    const SurfaceTriangles triangles = rooms.list();
    const BundleGrid grid = bundle_grid({0, 0, 1}, triangles.bounds, 0.0126f, {0.5f, 0.5f});
    const RayBundle bundle = BundleTracer(triangles).trace(grid);
    std::size_t links = 0;
    for_each_link(bundle, [&](auto, auto&, auto&) { ++links; });
    CHECK(links >= 1000000);
    CHECK(double(bundle.memory_bytes()) / double(links) * 1e7 < 300e6);
}
