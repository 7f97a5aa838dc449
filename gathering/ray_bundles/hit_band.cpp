#include "gathering/ray_bundles/hit_band.h"

#include <algorithm>
#include <bit>

namespace mote::gathering {
namespace {

/// Distances are not negative, so that their bits are in their order.
std::uint64_t key_of(const BundleHit& hit) {
    return std::uint64_t(std::bit_cast<std::uint32_t>(hit.distance)) << 32 | std::rotl(hit.triangle, 1);
}
template <typename Placed>
BundleHit hit_of(const Placed& p) {
    return {std::bit_cast<float>(std::uint32_t(p.key >> 32)), std::rotr(std::uint32_t(p.key), 1), p.u16,
            p.v16};
}

/// Most rays have a few hits.
template <typename Placed>
void sort_by_key(Placed* begin, Placed* end) {
    if (end - begin > 24) {
        std::sort(begin, end, [](const Placed& a, const Placed& b) { return a.key < b.key; });
        return;
    }
    for (Placed* at = begin; at < end; ++at) {
        const Placed moved = *at;
        Placed* hole = at;
        for (; hole > begin && moved.key < hole[-1].key; --hole) *hole = hole[-1];
        *hole = moved;
    }
}

/// Hits that rounding may have exchanged take turns: a front after a back, and first of all.
void take_turns(std::span<BundleHit> run, bool front_next) {
    const std::vector<BundleHit> all(run.begin(), run.end());
    std::vector<BundleHit> fronts, backs;
    for (const BundleHit& hit : all) (hit.from_behind() ? backs : fronts).push_back(hit);
    auto front = fronts.begin(), back = backs.begin();
    for (BundleHit& hit : run) {
        const bool takes_front = back == backs.end() || (front_next && front != fronts.end());
        hit = takes_front ? *front++ : *back++;
        front_next = !takes_front;
    }
}

void order_coincident(std::span<BundleHit> hits, float tolerance) {
    bool front_next = true;
    for (std::size_t begin = 0; begin < hits.size();) {
        std::size_t end = begin + 1;
        bool both = false;
        for (; end < hits.size() && hits[end].distance - hits[begin].distance <= tolerance; ++end)
            both = both || hits[end].from_behind() != hits[begin].from_behind();
        if (both) take_turns(hits.subspan(begin, end - begin), front_next);
        front_next = hits[end - 1].from_behind();
        begin = end;
    }
}

}  // namespace

OrderedBand HitBand::ordered(std::uint32_t rays, float tolerance) {
    OrderedBand band;
    band.counts.assign(rays, 0);
    for (const Found& found : found_) ++band.counts[found.ray];
    next_.resize(rays);
    std::uint32_t sum = 0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) next_[ray] = sum, sum += band.counts[ray];
    placed_.resize(found_.size());
    for (const Found& found : found_)
        placed_[next_[found.ray]++] = {key_of(found.hit), found.hit.u16, found.hit.v16};
    band.hits.reserve(found_.size());
    Placed* begin = placed_.data();
    for (const std::uint32_t count : band.counts) {
        sort_by_key(begin, begin + count);
        for (Placed* end = begin + count; begin != end; ++begin) band.hits.push_back(hit_of(*begin));
        order_coincident({band.hits.data() + band.hits.size() - count, count}, tolerance);
    }
    return band;
}

}  // namespace mote::gathering
