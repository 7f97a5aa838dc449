// The order of a ray's hits, against a sort that follows the rules one by one, for few and many hits.
#include "gathering/ray_bundles/hit_band.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "core/math/random.h"
#include "tests/support/catch.h"

using namespace mote;
using namespace mote::gathering;

namespace {

struct Ray {
    std::vector<BundleHit> hits;
};

/// Hits at distances of which many are equal where there are few different ones.
Ray random_ray(core::Rng& rng, std::uint32_t count, std::uint32_t distances) {
    Ray ray;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float distance = float(1 + rng.next_u32() % distances) * 0.25f;
        const std::uint32_t side = rng.next_u32() & BundleHit::behind_bit;
        // Triangles differ: what is equally far has one order only.
        ray.hits.push_back({distance, (1000 - i) | side, std::uint16_t(i), std::uint16_t(2 * i)});
    }
    return ray;
}

void sort_by_rule(std::vector<BundleHit>& hits) {
    std::sort(hits.begin(), hits.end(), [](const BundleHit& a, const BundleHit& b) {
        if (a.distance != b.distance) return a.distance < b.distance;
        return a.index() != b.index() ? a.index() < b.index() : b.from_behind() && !a.from_behind();
    });
}

std::vector<BundleHit> merged_by_rule(const std::vector<BundleHit>& hits, float merged) {
    std::vector<BundleHit> kept;
    const BundleHit* before = nullptr;
    for (const BundleHit& hit : hits) {
        const bool same_side = before != nullptr && before->from_behind() == hit.from_behind();
        if (!same_side || hit.distance - kept.back().distance > merged) kept.push_back(hit);
        before = &hit;
    }
    return kept;
}

bool same(std::span<const BundleHit> a, const std::vector<BundleHit>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BundleHit& x, const BundleHit& y) {
        return x.distance == y.distance && x.triangle == y.triangle && x.u16 == y.u16 && x.v16 == y.v16;
    });
}

/// Adds the hits of all rays in random order.
void fill(HitBand& band, const std::vector<Ray>& rays, core::Rng& rng) {
    std::vector<std::pair<std::uint32_t, BundleHit>> all;
    for (std::uint32_t ray = 0; ray < rays.size(); ++ray)
        for (const BundleHit& hit : rays[ray].hits) all.emplace_back(ray, hit);
    for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[rng.next_u32() % i]);
    band.clear();
    for (const auto& [ray, hit] : all) band.add(ray, hit);
}

}  // namespace

TEST_CASE("hits of any number come in order, each ray its own", "[bundles][hit_band]") {
    core::Rng rng(7);
    HitBand band;
    for (const std::uint32_t distances : {3u, 40u, 100000u}) {
        std::vector<Ray> rays;
        // All counts up to where others ways of sorting begin, empty rays, and the longest one last.
        for (std::uint32_t count = 0; count <= 70; ++count) rays.push_back(random_ray(rng, count, distances));
        for (std::uint32_t i = 0; i < 70; ++i) rays.push_back(random_ray(rng, rng.next_u32() % 5, distances));
        rays.push_back(random_ray(rng, 300, distances));
        for (const float merged : {0.0f, 0.6f}) {
            fill(band, rays, rng);
            // Fronts and backs at one place take turns, which is tested elsewhere: here they keep their
            // order.
            const OrderedBand ordered = band.ordered(std::uint32_t(rays.size()), {-1.0f, merged});
            REQUIRE(ordered.counts.size() == rays.size());
            std::size_t first = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                std::vector<BundleHit> expected = rays[i].hits;
                sort_by_rule(expected);
                if (merged > 0.0f) expected = merged_by_rule(expected, merged);
                INFO("ray " << i << " of " << rays[i].hits.size() << " hits, merged within " << merged);
                CHECK(same(std::span(ordered.hits).subspan(first, ordered.counts[i]), expected));
                first += ordered.counts[i];
            }
            CHECK(first == ordered.hits.size());
        }
    }
}

TEST_CASE("coincident fronts and backs take turns before hits are merged", "[bundles][hit_band]") {
    // A leaf of two sides, seen twice because two discs overlap: back and front at 1, both again at 1.001.
    const std::uint32_t behind = BundleHit::behind_bit;
    HitBand band;
    for (const std::uint32_t triangle : {5u | behind, 4u})
        for (const float distance : {1.0f, 1.001f}) band.add(0, {distance, triangle, 0, 0});
    const OrderedBand turns = band.ordered(1, {0.01f, 0.0f});
    REQUIRE(turns.hits.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) CHECK(turns.hits[i].from_behind() == (i % 2 == 1));
}
