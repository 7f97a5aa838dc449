#include "gathering/ray_bundles/hit_order.h"

#include <algorithm>
#include <limits>

#include "gathering/ray_bundles/coincident_hits.h"
#include "gathering/ray_bundles/lanes.h"

namespace mote::gathering {
namespace {

/// Hits by distance that are equally far go by their triangles, then their sides.
void order_equal(std::span<HitKey> hits, const FoundHit* found) {
    const auto is_before = [&](const HitKey& a, const HitKey& b) {
        if (a.distance() != b.distance()) return a.distance() < b.distance();
        return std::rotl(found[a.number()].hit.triangle, 1) < std::rotl(found[b.number()].hit.triangle, 1);
    };
    for (std::size_t i = 1; i < hits.size(); ++i)
        for (std::size_t j = i; j > 0 && is_before(hits[j], hits[j - 1]); --j)
            std::swap(hits[j], hits[j - 1]);
}

/// Properties of neighbours in order of distance. Without branches, which would mostly be mispredicted.
struct Neighbours {
    std::uint32_t equal = 0;       ///< 1: two are equally far
    std::uint32_t coincident = 0;  ///< 1: a front and a back are within the tolerance
    Neighbours(std::span<const HitKey> hits, float tolerance) {
        for (std::size_t i = 1; i < hits.size(); ++i) {
            const float gap = hits[i].distance() - hits[i - 1].distance();
            equal |= std::uint32_t(gap == 0.0f);
            coincident |= std::uint32_t(gap <= tolerance) & (hits[i].side() ^ hits[i - 1].side());
        }
    }
};

/// Merges hits; returns the number of those that are left, in front.
std::uint32_t merge(std::span<HitKey> hits, float merged) {
    std::uint32_t kept = 1, side = hits[0].side();
    float limit = hits[0].distance() + merged;
    for (std::size_t i = 1; i < hits.size(); ++i) {
        const HitKey hit = hits[i];
        const float distance = hit.distance();
        const std::uint32_t keeps = (hit.side() ^ side) | std::uint32_t(distance > limit);
        hits[kept] = hit, kept += keeps;
        const float limits[2] = {limit, distance + merged};  // compilers make branches of more direct forms
        limit = limits[keeps], side = hit.side();
    }
    return kept;
}

/// Every hit goes where as many are nearer as places come before. All pairs are compared, without a branch,
/// and as if there were 4 `vectors` of them: counts that differ from ray to ray would be mispredicted. Keys
/// are compared as the doubles of their bits, which have the same order: twice as fast as whole numbers.
template <int vectors>
void put_by_rank(const HitKey* keys, std::size_t count, HitKey* sorted) {
    constexpr int most = 4 * vectors;
    const Double4 behind = Double4{} + std::numeric_limits<double>::infinity();
    double all[most];
    std::int64_t ranks[most];
    Double4 key[vectors];
    Long4 rank[vectors];
    for (int v = 0; v < vectors; ++v) {
        const Long4 is_hit = Long4{0, 1, 2, 3} + std::int64_t(4 * v) < Long4{} + std::int64_t(count);
        load(keys + 4 * v, key[v]);
        key[v] = is_hit ? key[v] : behind, rank[v] = Long4{};
        store(key[v], all + 4 * v);
    }
    const int compared = vectors > 2 ? int(count) : most;
    for (int j = 0; j < compared; ++j)
        for (int v = 0; v < vectors; ++v) rank[v] -= Double4{} + all[j] < key[v];
    for (int v = 0; v < vectors; ++v) store(rank[v], ranks + 4 * v);
    for (int i = 0; i < most; ++i)  // what is no hit goes behind the last
        sorted[ranks[i]].bits = std::bit_cast<std::int64_t>(all[i]);
}

void sort_by_distance(std::span<const HitKey> keys, std::size_t readable, HitKey* sorted) {
    using Ranked = void (*)(const HitKey*, std::size_t, HitKey*);
    constexpr Ranked ranked[] = {put_by_rank<1>, put_by_rank<2>, put_by_rank<3>, put_by_rank<4>,
                                 put_by_rank<5>, put_by_rank<6>, put_by_rank<7>, put_by_rank<8>};
    const std::size_t count = keys.size(), vectors = (count + 3) / 4;
    if (count == 1) {
        sorted[0] = keys[0];
    } else if (vectors <= std::size(ranked) && 4 * vectors <= readable) {
        ranked[vectors - 1](keys.data(), count, sorted);
    } else {
        std::copy(keys.begin(), keys.end(), sorted);
        std::sort(sorted, sorted + count, [](HitKey a, HitKey b) { return a.bits < b.bits; });
    }
}

}  // namespace

std::uint32_t order_hits(std::span<const HitKey> keys, std::size_t readable, const HitOrder& order,
                         const FoundHit* found, HitKey* ordered) {
    sort_by_distance(keys, readable, ordered);
    const std::span<HitKey> hits(ordered, keys.size());
    const Neighbours neighbours(hits, order.coincident);
    if (neighbours.equal != 0) order_equal(hits, found);
    if (neighbours.coincident != 0) order_coincident(hits, order.coincident);
    return order.merged > 0.0f ? merge(hits, order.merged) : std::uint32_t(hits.size());
}

}  // namespace mote::gathering
