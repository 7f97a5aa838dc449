#include "gathering/ray_bundles/hit_band.h"

#include <algorithm>

namespace mote::gathering {
namespace {

bool is_before(const BundleHit& a, const BundleHit& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    return a.index() < b.index();
}

/// Most rays have a few hits.
void sort_by_distance(std::span<BundleHit> hits) {
    if (hits.size() > 16) {
        std::sort(hits.begin(), hits.end(), is_before);
        return;
    }
    for (std::size_t i = 1; i < hits.size(); ++i) {
        const BundleHit hit = hits[i];
        std::size_t j = i;
        for (; j > 0 && is_before(hit, hits[j - 1]); --j) hits[j] = hits[j - 1];
        hits[j] = hit;
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
    band.hits.resize(found_.size());
    for (const Found& found : found_) band.hits[next_[found.ray]++] = found.hit;
    std::size_t first = 0;
    for (const std::uint32_t count : band.counts) {
        const std::span<BundleHit> hits(band.hits.data() + first, count);
        sort_by_distance(hits), order_coincident(hits, tolerance);
        first += count;
    }
    return band;
}

}  // namespace mote::gathering
