#include "gathering/ray_bundles/coincident_hits.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mote::gathering {
namespace {

/// Hits that rounding may have exchanged take turns: a front after a back, and first of all.
void alternate(std::span<HitKey> run, bool front_next) {
    std::vector<HitKey> fronts, backs;
    for (const HitKey& hit : run) (hit.from_behind() ? backs : fronts).push_back(hit);
    auto front = fronts.begin(), back = backs.begin();
    for (HitKey& hit : run) {
        const bool takes_front = back == backs.end() || (front_next && front != fronts.end());
        hit = takes_front ? *front++ : *back++;
        front_next = !takes_front;
    }
}

/// Hits from `begin` on that may coincide with it.
struct Coincident {
    std::size_t end;
    bool both = false;  ///< fronts and backs
    Coincident(std::span<const HitKey> hits, std::size_t begin, float tolerance) : end(begin + 1) {
        const float distance = hits[begin].distance();
        for (; end < hits.size() && std::fabs(hits[end].distance() - distance) <= tolerance; ++end)
            both = both || hits[end].from_behind() != hits[begin].from_behind();
    }
};

void alternate_from_the_start(std::span<HitKey> hits, float tolerance) {
    bool front_next = true;
    for (std::size_t begin = 0; begin < hits.size();) {
        const auto [end, both] = Coincident(hits, begin, tolerance);
        if (both) alternate(hits.subspan(begin, end - begin), front_next);
        front_next = hits[end - 1].from_behind();
        begin = end;
    }
}

void reverse(std::span<HitKey> hits) {
    std::reverse(hits.begin(), hits.end());
    for (HitKey& hit : hits) hit.turn();
}

}  // namespace

void order_coincident(std::span<HitKey> hits, float tolerance) {
    const bool mixed_first = Coincident(hits, 0, tolerance).both;
    if (mixed_first) reverse(hits);
    if (mixed_first && !Coincident(hits, 0, tolerance).both) {
        alternate_from_the_start(hits, tolerance);
        reverse(hits);
        return;
    }
    if (mixed_first) reverse(hits);
    alternate_from_the_start(hits, tolerance);
}

}  // namespace mote::gathering
