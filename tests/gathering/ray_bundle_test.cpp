// Hits of a bundle: every crossing once, in order, with rays and with a scan alike.
#include <tbb/global_control.h>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "gathering/ray_bundles/bundle_directions.h"
#include "tests/gathering/bundle_scenes.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;
using tests::TriangleBuilder;

namespace {

/// A closed surface of many small triangles around the origin whose edges are shared to the bit.
SurfaceTriangles bumpy_ball(int columns, int rows) {
    const auto corner = [&](int i, int j) {
        if (j == 0 || j == rows) i = 0;
        const float theta = pi * float(j) / float(rows),
                    phi = 2.0f * pi * float(i % columns) / float(columns);
        const float radius = 1.0f + 0.1f * std::sin(5.0f * phi) * std::sin(theta) * std::sin(4.0f * theta);
        return radius *
               Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    };
    TriangleBuilder ball;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            if (j > 0) ball.triangle(corner(i, j), corner(i, j + 1), corner(i + 1, j));
            if (j + 1 < rows) ball.triangle(corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
        }
    return ball.list();
}

/// Fronts and backs in turn: a ray enters a closed body as often as it leaves it, and never twice.
std::size_t rays_out_of_turn(const RayBundle& bundle) {
    std::size_t wrong = 0;
    for (std::size_t ray = 0; ray < bundle.grid.rays(); ++ray) {
        const auto hits = bundle.hits_of(ray);
        bool in_turn = hits.size() % 2 == 0;
        for (std::size_t i = 0; i < hits.size(); ++i)
            in_turn = in_turn && hits[i].from_behind() == (i % 2 == 1);
        wrong += !in_turn;
    }
    return wrong;
}

bool same_bundles(const RayBundle& a, const RayBundle& b) {
    return a.first == b.first && a.hits.size() == b.hits.size() &&
           std::equal(a.hits.begin(), a.hits.end(), b.hits.begin(),
                      [](const BundleHit& x, const BundleHit& y) {
                          return x.distance == y.distance && x.triangle == y.triangle && x.u16 == y.u16 &&
                                 x.v16 == y.v16;
                      });
}

}  // namespace

TEST_CASE("every ray through a closed body enters and leaves it in turn", "[ray_bundles]") {
    const SurfaceTriangles ball = bumpy_ball(60, 30);
    const BundleTracer tracer(ball);
    Rng rng(1);
    std::size_t hits = 0;
    for (int i = 0; i < 20; ++i) {
        const Vec3 direction = square_to_sphere({rng.next_float(), rng.next_float()});
        const RayBundle bundle =
            tracer.trace(bundle_grid(direction, ball.bounds, 0.01f, {rng.next_float(), rng.next_float()}));
        CHECK(rays_out_of_turn(bundle) == 0);
        hits += bundle.hits.size();
    }
    CHECK(hits > 20 * 2 * 25000);  // pi / 0.01^2 rays meet it
}

TEST_CASE("rays exactly through edges and corners count one crossing", "[ray_bundles]") {
    // A square of 64 x 64 cells with a corner at every ray and an edge between all of them.
    TriangleBuilder builder;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto at = [&](int i, int j) { return Vec3(float(x + i), float(y + j), 0.0f); };
            if ((x + y) % 2 == 0)
                builder.quad(at(0, 0), at(1, 0), at(1, 1), at(0, 1));
            else
                builder.quad(at(1, 0), at(1, 1), at(0, 1), at(0, 0));
        }
    const SurfaceTriangles square = builder.list();
    const BundleTracer tracer(square);
    for (const float spacing : {1.0f, 0.5f, 0.25f}) {
        BundleGrid grid;
        grid.direction = {0, 0, 1}, grid.right = {1, 0, 0}, grid.up = {0, 1, 0}, grid.spacing = spacing;
        grid.origin = Vec3(-spacing / 2, -spacing / 2, -1.0f);
        grid.columns = grid.rows = std::uint32_t(64.0f / spacing) + 1;
        const RayBundle bundle = tracer.trace(grid);
        std::size_t inside = 0;
        for (std::uint32_t y = 0; y < grid.rows; ++y)
            for (std::uint32_t x = 0; x < grid.columns; ++x) {
                const std::size_t count = bundle.hits_of(y * grid.columns + x).size();
                if (x > 0 && y > 0 && x + 1 < grid.columns && y + 1 < grid.rows) CHECK(count == 1);
                inside += count;
            }
        // Two sides of the border count: the square is as large as its area says.
        CHECK(inside == std::size_t(grid.columns - 1) * (grid.rows - 1));
    }
}

TEST_CASE("positions of hits lie on their ray and in their triangle", "[ray_bundles]") {
    const SurfaceTriangles ball = bumpy_ball(24, 12);
    const BundleTracer tracer(ball);
    const BundleGrid grid = bundle_grid(glm::normalize(Vec3(1, -2, 0.5f)), ball.bounds, 0.05f, {0.3f, 0.8f});
    const RayBundle bundle = tracer.trace(grid);
    REQUIRE(bundle.hits.size() > 1000);
    for (std::uint32_t ray = 0; ray < grid.rays(); ++ray)
        for (const BundleHit& hit : bundle.hits_of(ray)) {
            const Vec3 p =
                grid.ray_origin(ray % grid.columns, ray / grid.columns) + hit.distance * grid.direction;
            const auto& c = ball.corners[hit.index()];
            const Vec3 q = (1.0f - hit.u() - hit.v()) * c[0] + hit.u() * c[1] + hit.v() * c[2];
            CHECK(glm::length(p - q) < 2e-5f);  // of sides of 0.5: two steps of u16, and rounding
            const Vec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
            CHECK((glm::dot(cross, grid.direction) > 0.0f) == hit.from_behind());
            CHECK(hit.u16 + hit.v16 <= 65535);
        }
}

TEST_CASE("bundles have the same bits for any number of threads", "[ray_bundles]") {
    const SurfaceTriangles ball = bumpy_ball(60, 30);
    const BundleTracer tracer(ball);
    const BundleGrid grid = bundle_grid(glm::normalize(Vec3(1, 2, 3)), ball.bounds, 0.02f, {0.1f, 0.2f});
    const RayBundle many = tracer.trace(grid);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(same_bundles(many, tracer.trace(grid)));
}

TEST_CASE("rays and scan find the same hits", "[ray_bundles]") {
    // Triangles of all sizes and shapes in any place, with some that coincide.
    Rng rng(7);
    TriangleBuilder builder;
    const auto corner = [&](float size) {
        return size * (2.0f * Vec3(rng.next_float(), rng.next_float(), rng.next_float()) - Vec3(1.0f));
    };
    for (int i = 0; i < 3000; ++i) {
        const Vec3 center = corner(1.0f);
        const float size = std::exp(-6.0f * rng.next_float());
        const Vec3 a = center + corner(size), b = center + corner(size), c = center + corner(size);
        builder.triangle(a, b, c);
        if (i % 50 == 0) builder.triangle(a, c, b);
    }
    const SurfaceTriangles soup = builder.list();
    const BundleTracer tracer(soup);
    for (const float spacing : {0.3f, 0.05f, 0.01f}) {
        const BundleSample sample = bundle_sample(3, 5);
        const BundleGrid grid = bundle_grid(sample.direction, soup.bounds, spacing, sample.offset);
        const RayBundle rays = tracer.trace(grid, {BundleForm::rays});
        CHECK(rays.hits.size() > 100);
        CHECK(same_bundles(rays, tracer.trace(grid, {BundleForm::scan})));
        // One hit that is left out is seen.
        RayBundle planted = rays;
        planted.hits.erase(planted.hits.begin() + 17);
        for (std::uint32_t& first : planted.first) first -= first > 17;
        CHECK_FALSE(same_bundles(planted, tracer.trace(grid, {BundleForm::scan})));
    }
}
