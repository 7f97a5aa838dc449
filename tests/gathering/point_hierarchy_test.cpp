// The tree of points: every node is where level and index say, and holds what is below it.
#include <algorithm>
#include <numeric>
#include <random>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/objects/error.h"
#include "gathering/point_hierarchy/node_radiance.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::core;
using namespace mote::gathering;

namespace {

Surfels points_in_a_ball(std::uint32_t count) {
    Surfels s;
    Rng rng(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3 n = square_to_sphere(rng.next_vec2());
        s.positions.push_back(rng.next_float() * square_to_sphere(rng.next_vec2()));
        s.normals.push_back(n), s.places.push_back({i, 0.0f, 0.0f});
    }
    s.radius = 0.01f, s.area = 1.0;
    return s;
}

/// A square grid of 2^k x 2^k points at distances of 1, in random order.
Surfels square_grid(std::uint32_t side) {
    Surfels s;
    std::vector<std::uint32_t> places(side * side);
    std::iota(places.begin(), places.end(), 0u);
    std::shuffle(places.begin(), places.end(), std::mt19937(1));
    for (const std::uint32_t i : places) {
        s.positions.emplace_back(float(i % side), float(i / side), 0.0f);
        s.normals.emplace_back(0.0f, 0.0f, 1.0f), s.places.push_back({i, 0.0f, 0.0f});
    }
    s.radius = 0.1f, s.area = double(side * side);
    return s;
}

}  // namespace

TEST_CASE("a walk that enters all nodes meets each once, one that enters none ends", "[point_hierarchy]") {
    for (std::uint32_t count = 1; count < 70; ++count) {
        const PointHierarchy h(points_in_a_ball(count));
        std::vector<int> met(h.nodes().size());
        std::uint32_t next_leaf = 0;
        for (NodePlace p = h.root(); h.exists(p); p = p.level > 0 ? p.first_child() : p.skip()) {
            ++met[h.node_index(p)];
            if (p.level == 0) CHECK(p.index == next_leaf++);
            // skip() leaves out the nodes below and no others.
            const NodePlace after = p.skip();
            if (h.exists(after)) CHECK(after.index << after.level == (p.index + 1) << p.level);
        }
        CHECK(next_leaf == count);
        CHECK(std::all_of(met.begin(), met.end(), [](int m) { return m == 1; }));
        CHECK_FALSE(h.exists(h.root().skip()));
        CHECK(h.points_below(h.root()) == count);
    }
}

TEST_CASE("nodes hold the points below them, and faces of all", "[point_hierarchy]") {
    const Surfels s = points_in_a_ball(1000);
    const PointHierarchy h(s);
    std::vector<std::uint32_t> sorted(h.order().begin(), h.order().end());
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < 1000; ++i) CHECK(sorted[i] == i);
    for (std::uint32_t level = 0; level < h.levels(); ++level)
        for (std::uint32_t i = 0; i < h.count(level); ++i) {
            const PointNode& node = h.nodes()[h.node_index({level, i})];
            bool holds = true;
            for (std::uint32_t k = 0; k < h.points_below({level, i}); ++k) {
                const std::uint32_t at = h.order()[(i << level) + k];
                holds &= glm::length(s.positions[at] - node.center) <= node.radius;
                holds &= glm::dot(s.normals[at], node.axis) >= node.cone_cos - 1e-6f;
            }
            CHECK(holds);
        }
}

// Half the diagonal of 2^k x 2^k points, and 0.9 of a disc.
TEST_CASE("cuts at medians make squares of a square grid", "[point_hierarchy]") {
    const PointHierarchy h(square_grid(16));
    for (std::uint32_t k = 0; k <= 4; ++k)
        for (std::uint32_t i = 0; i < h.count(2 * k); ++i) {
            const float radius = h.nodes()[h.node_index({2 * k, i})].radius;
            CHECK(radius == Approx(std::sqrt(0.5) * ((1 << k) - 1) + (k == 0 ? 0.1 : 0.09)).epsilon(1e-5));
        }
}

TEST_CASE("light of nodes is the mean of their points, side by side", "[point_hierarchy]") {
    const PointHierarchy h(points_in_a_ball(37));
    std::vector<Rgb> front(37), back(37);
    Rng rng(3);
    for (std::size_t i = 0; i < 37; ++i) front[i] = Rgb(rng.next_float()), back[i] = Rgb(0, float(i), 1);
    const NodeRadiance light(h, front, back), dark(h, front);
    for (std::uint32_t level = 0; level < h.levels(); ++level)
        for (std::uint32_t i = 0; i < h.count(level); ++i) {
            const NodePlace place{level, i};
            Vec3d sum(0.0), behind(0.0);
            for (std::uint32_t k = 0; k < h.points_below(place); ++k) {
                sum += Vec3d(front[h.order()[(i << level) + k]]);
                behind += Vec3d(back[h.order()[(i << level) + k]]);
            }
            const double count = h.points_below(place);
            const std::uint32_t node = h.node_index(place);
            CHECK(glm::length(Vec3d(light.of(node, false)) - sum / count) < 1e-6);
            CHECK(glm::length(Vec3d(light.of(node, true)) - behind / count) < 1e-5);
            CHECK(dark.of(node, true) == Rgb(0.0f));
        }
    CHECK_THROWS_AS(NodeRadiance(h, std::vector<Rgb>(36)), InputError);
    front[5].y = std::nanf("");
    CHECK_THROWS_AS(NodeRadiance(h, front), InputError);
}

TEST_CASE("hierarchies at the extremes", "[point_hierarchy]") {
    const PointHierarchy none{Surfels()};
    CHECK((none.empty() && none.levels() == 0 && !none.exists({0, 0})));
    const PointHierarchy one(points_in_a_ball(1));
    CHECK((one.levels() == 1 && one.root().level == 0 && one.exists(one.root())));
    Surfels same = points_in_a_ball(100);
    for (Vec3& p : same.positions) p = Vec3(1, 2, 3);
    for (const PointNode& node : PointHierarchy(same).nodes())
        CHECK((is_finite(node.center) && is_finite(node.axis) && node.radius < 0.02f));
    Surfels opposed = points_in_a_ball(2);
    opposed.normals = {Vec3(0, 0, 1), Vec3(0, 0, -1)};
    CHECK(PointHierarchy(opposed).nodes().back().cone_cos == -1.0f);
    // 2^24 points are requested before anything is taken; the message says how many fit.
    Surfels many;
    many.positions.resize(PointHierarchy::largest_count), many.area = 1.0;
    CHECK_THROWS_WITH(PointHierarchy(many, std::size_t(1) << 30),
                      ContainsSubstring("16777216 points") && ContainsSubstring("15790320 points fit"));
    many.positions.resize(PointHierarchy::largest_count + 1);
    CHECK_THROWS_WITH(PointHierarchy(many, std::size_t(1) << 40), ContainsSubstring("16777216 points fit"));
}
