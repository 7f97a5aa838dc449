// Imperfect bundles: discs have the area that they represent, lie in their triangles, and approach the exact
// bundle as there are more of them.
#include <tbb/global_control.h>

#include "experiments/studies/ray_bundles/link_comparison.h"
#include "gathering/ray_bundles/imperfect_bundles.h"
#include "tests/gathering/form_factors.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::TriangleBuilder;

namespace {

/// A room with two boxes in it; its triangles are of very different sizes.
SurfaceTriangles furnished_room() {
    return TriangleBuilder()
        .box({0, 0, 0}, {4, 3, 5}, true, 0)
        .box({0.5f, 0.5f, 0.2f}, {1.5f, 1.2f, 2.0f}, false, 6)
        .box({2.5f, 1.0f, 0.4f}, {2.6f, 2.5f, 3.0f}, false, 12)
        .list();
}

BundleGrid grid_of(const SurfaceTriangles& triangles, std::uint64_t index, float spacing) {
    const BundleSample sample = bundle_sample(11, index);
    return bundle_grid(sample.direction, triangles.bounds, spacing, sample.offset);
}

LinkComparison error_with(const SurfaceTriangles& room, std::uint32_t points, float splat_size) {
    const BundleTracer exact(room);
    const ImperfectBundles imperfect(room, points, 4);
    LinkComparison result;
    for (std::uint32_t i = 0; i < 8; ++i) {
        const BundleGrid grid = grid_of(room, i, 0.1f);
        const ImperfectSettings settings{.splat_size = splat_size};
        result.add(compare_links(exact.trace(grid), imperfect.trace(grid, i, settings),
                                 float(imperfect.disc_radius(settings)), false));
    }
    return result;
}

}  // namespace

TEST_CASE("points lie on surfaces by their area", "[imperfect]") {
    const SurfaceTriangles room = furnished_room();
    const SurfacePoints surface(room);
    std::vector<SurfacePoint> points;
    std::vector<double> share(room.size());
    for (std::uint64_t set = 0; set < 8; ++set) {
        surface.sample(set, 4096, 0, 4096, points);
        REQUIRE(points.size() == 4096);
        for (const SurfacePoint& p : points) {
            share[p.triangle] += surface.area() / (8.0 * 4096.0);
            CHECK((p.u >= 0.0f && p.v >= 0.0f && p.u + p.v <= 1.000001f));
        }
    }
    for (std::size_t i = 0; i < room.size(); ++i) {
        const auto& c = room.corners[i];
        const double area = 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
        // Each set has at most one patch more or less at either end of a triangle.
        CHECK(std::fabs(share[i] - area) <= 2.0 * surface.area() / 4096.0);
    }
    // Any part of a set is that part of the whole.
    std::vector<SurfacePoint> part;
    surface.sample(3, 4096, 1000, 1010, part), surface.sample(3, 4096, 0, 4096, points);
    for (std::size_t i = 0; i < 10; ++i)
        CHECK((part[i].triangle == points[1000 + i].triangle && part[i].u == points[1000 + i].u));
}

TEST_CASE("discs have the area that they represent, in the plane of their triangle", "[imperfect]") {
    const SurfaceTriangles room = furnished_room();
    const ImperfectBundles imperfect(room, 2048, 16);
    const BundleTracer exact(room);
    for (const float size : {0.7f, 1.0f, 1.6f}) {
        tests::SeedMean ratio;
        for (std::uint32_t i = 0; i < 16; ++i) {
            const BundleGrid grid = grid_of(room, i, 0.02f);
            // Without merging every disc counts.
            const RayBundle bundle = imperfect.trace(grid, i, {.splat_size = size, .merge = 0.0f});
            ratio.add(double(bundle.hits.size()) / double(exact.trace(grid).hits.size()));
            if (i > 0) continue;
            for (std::uint32_t ray = 0; ray < grid.rays(); ++ray)
                for (const BundleHit& hit : bundle.hits_of(ray)) {
                    const auto& c = room.corners[hit.index()];
                    const Vec3 p = grid.ray_origin(ray % grid.columns, ray / grid.columns) +
                                   hit.distance * grid.direction;
                    const Vec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]), n = glm::normalize(cross);
                    CHECK(std::fabs(glm::dot(p - c[0], n)) < 1e-4f);
                    CHECK((glm::dot(n, grid.direction) > 0.0f) == hit.from_behind());
                    const bool inside = hit.u16 > 0 && hit.v16 > 0 && hit.u16 + hit.v16 < 65534;
                    const Vec3 q = c[0] + hit.u() * (c[1] - c[0]) + hit.v() * (c[2] - c[0]);
                    if (inside) CHECK(glm::length(p - q) < 4e-4f);
                }
        }
        INFO(size << ": " << ratio.mean() << " +- " << ratio.error());
        CHECK(std::fabs(ratio.z(double(size) * double(size))) < 4.5);
        CHECK(ratio.error() < 0.01 * double(size));
        CHECK(std::fabs(ratio.z(1.05 * 1.05 * double(size) * double(size))) >
              4.5);  // five per cent more radius
    }
}

TEST_CASE("a set of points that ends within a block has as many discs as points", "[imperfect]") {
    const SurfaceTriangles room = furnished_room();
    const ImperfectBundles imperfect(room, 70, 64);
    const BundleTracer exact(room);
    tests::SeedMean ratio;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const BundleGrid grid = grid_of(room, i, 0.1f);
        const RayBundle bundle = imperfect.trace(grid, i, {.splat_size = 0.8f, .merge = 0.0f});
        ratio.add(double(bundle.hits.size()) / double(exact.trace(grid).hits.size()));
    }
    INFO(ratio.mean() << " +- " << ratio.error());
    CHECK(std::fabs(ratio.z(0.64)) < 4.5);
    CHECK(std::fabs(ratio.z(0.64 * 128.0 / 70.0)) > 4.5);  // the whole of the last block
}

TEST_CASE("imperfect bundles approach exact ones with more points", "[imperfect]") {
    const SurfaceTriangles room = furnished_room();
    const LinkComparison few = error_with(room, 512, 1.6f), some = error_with(room, 4096, 1.6f),
                         many = error_with(room, 32768, 1.6f);
    INFO(few.missing() << " " << some.missing() << " " << many.missing() << " missing, " << few.wrong() << " "
                       << some.wrong() << " " << many.wrong() << " wrong");
    // Errors lie within a disc of an edge, or in a hole: the radius falls by the root of eight.
    CHECK(many.missing() < 0.6 * some.missing());
    CHECK(some.missing() < 0.6 * few.missing());
    CHECK(many.wrong() < 0.6 * some.wrong());
    CHECK(some.wrong() < 0.6 * few.wrong());
    CHECK(many.missing() < 0.05);
    CHECK(many.wrong() < 0.05);
    // Larger discs close holes.
    CHECK(error_with(room, 4096, 1.0f).missing() > some.missing());
    // An exact bundle has no error against itself.
    const BundleTracer exact(room);
    const RayBundle bundle = exact.trace(grid_of(room, 0, 0.1f));
    const LinkComparison none = compare_links(bundle, bundle, 0.0f, false);
    CHECK((none.exact > 100 && none.shared == none.exact && none.other == none.exact));
}

TEST_CASE(
    "imperfect bundles have the same bits for any number of threads, and another set for another direction",
    "[imperfect]") {
    const SurfaceTriangles room = furnished_room();
    const ImperfectBundles imperfect(room, 4096, 4);
    const BundleGrid grid = grid_of(room, 2, 0.03f);
    const auto same = [](const RayBundle& a, const RayBundle& b) {
        return a.first == b.first &&
               std::equal(a.hits.begin(), a.hits.end(), b.hits.begin(), b.hits.end(), [](auto& x, auto& y) {
                   return x.distance == y.distance && x.triangle == y.triangle && x.u16 == y.u16 &&
                          x.v16 == y.v16;
               });
    };
    const RayBundle many = imperfect.trace(grid, 1);
    CHECK(same(many, imperfect.trace(grid, 5)));
    CHECK_FALSE(same(many, imperfect.trace(grid, 2)));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(same(many, imperfect.trace(grid, 1)));
}

TEST_CASE("imperfect bundles at the extremes", "[imperfect]") {
    const SurfaceTriangles nothing, line = TriangleBuilder().triangle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}).list();
    const BundleGrid grid = bundle_grid({0, 0, 1}, {Vec3(0.0f), Vec3(1.0f)}, 0.1f, {0, 0});
    for (const SurfaceTriangles* triangles : {&nothing, &line}) {
        const RayBundle bundle = ImperfectBundles(*triangles, 100, 2).trace(grid, 0);
        CHECK(bundle.first == std::vector<std::uint32_t>(grid.rays() + 1, 0));
    }
    const SurfaceTriangles room = furnished_room();
    CHECK_THROWS_AS(ImperfectBundles(room, 0), InputError);
    CHECK_THROWS_AS(ImperfectBundles(room, 100, 0), InputError);
    const ImperfectBundles imperfect(room, 100, 1);
    CHECK_THROWS_AS(imperfect.trace(grid, 0, {.splat_size = 0.0f}), InputError);
    CHECK_THROWS_AS(imperfect.trace(grid, 0, {.splat_size = std::nanf("")}), InputError);
    CHECK_THROWS_AS(imperfect.trace(grid, 0, {.memory_budget = 100}), InputError);
    // Discs on edge, discs far larger than the scene, and such as reach before the rays' origins.
    for (const Vec3& direction : {Vec3(0, 0, 1), glm::normalize(Vec3(1, 2, 3))}) {
        const BundleGrid along = bundle_grid(direction, room.bounds, 0.1f, {0.5f, 0.5f});
        for (const float size : {1e-4f, 1.0f, 100.0f}) {
            const RayBundle bundle = imperfect.trace(along, 0, {.splat_size = size});
            for (const BundleHit& hit : bundle.hits)
                CHECK((is_finite(hit.distance) && hit.distance > 0.0f && hit.u16 + hit.v16 <= 65535));
        }
    }
}
