// The k nearest points against brute force, and what a tree of awkward points does.
#include "core/math/kd_tree.h"

#include <algorithm>
#include <numeric>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote::core;

namespace {

std::vector<Vec3> random_points(std::size_t count, std::uint64_t seed, float grid = 0.0f) {
    Rng rng(seed);
    std::vector<Vec3> points(count);
    for (Vec3& p : points) {
        p = Vec3(rng.next_float(), 0.2f * rng.next_float(), sqr(rng.next_float()));
        if (grid > 0.0f) p = glm::floor(p / grid) * grid;  // many points and coordinates coincide
    }
    return points;
}

/// Distances of the k nearest, sorted, by reading every point.
std::vector<float> nearest_by_force(const std::vector<Vec3>& points, const Vec3& p, std::size_t k,
                                    float limit) {
    std::vector<float> d;
    for (const Vec3& q : points) {
        const float squared = glm::dot(p - q, p - q);
        if (squared <= sqr(limit)) d.push_back(squared);
    }
    std::sort(d.begin(), d.end());
    d.resize(std::min(k, d.size()));
    return d;
}

}  // namespace

TEST_CASE("The k nearest points are those that reading every point finds", "[kd_tree]") {
    for (const float grid : {0.0f, 0.125f})
        for (const std::size_t count :
             {std::size_t(1), std::size_t(2), std::size_t(37), std::size_t(20000)}) {
            const auto points = random_points(count, count, grid);
            const KdTree tree(points);
            std::vector<KdTree::Neighbour> found;
            Rng rng(7);
            for (int query = 0; query < 50; ++query) {
                const Vec3 p(1.4f * rng.next_float() - 0.2f, rng.next_float(), rng.next_float());
                const std::size_t k = 1 + rng.next_u32() % 60;
                const float limit = query % 2 ? infinity : 0.3f;
                tree.nearest(p, k, limit, found);
                REQUIRE(std::is_heap(found.begin(), found.end()));
                std::sort(found.begin(), found.end());
                const auto expected = nearest_by_force(points, p, k, limit);
                REQUIRE(found.size() == expected.size());
                for (std::size_t i = 0; i < found.size(); ++i) {
                    REQUIRE(found[i].distance_squared == expected[i]);
                    REQUIRE(tree.point(found[i].index) == points[tree.order()[found[i].index]]);
                }
            }
        }
}

TEST_CASE("The order of a kd-tree is a permutation, the same for every build", "[kd_tree]") {
    const auto points = random_points(50000, 3, 0.05f);
    const KdTree a(points), b(points);
    std::vector<std::uint32_t> order(a.order().begin(), a.order().end());
    CHECK(std::equal(order.begin(), order.end(), b.order().begin()));
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) REQUIRE(order[i] == i);
}

TEST_CASE("Empty trees, coincident points and k = 0 have answers", "[kd_tree]") {
    std::vector<KdTree::Neighbour> found(3);
    KdTree().nearest(Vec3(0.0f), 5, infinity, found);
    CHECK(found.empty());
    const std::vector<Vec3> same(1000, Vec3(1, 2, 3));
    KdTree tree(same);
    tree.nearest(Vec3(1, 2, 3), 10, infinity, found);
    CHECK(found.size() == 10);
    CHECK(found.front().distance_squared == 0.0f);
    tree.nearest(Vec3(1, 2, 3), 0, infinity, found);
    CHECK(found.empty());
    tree.forget_order();
    CHECK(tree.memory_bytes() == 1000 * KdTree::bytes_per_point);
}
