#include "gathering/ray_bundles/hit_band.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace mote::gathering {
namespace {

std::uint32_t triangle_key(const BundleHit& hit) {
    return std::rotl(hit.triangle, 1);
}  // by index, then side

bool is_before(const BundleHit& a, const BundleHit& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    return triangle_key(a) < triangle_key(b);
}

constexpr std::size_t most_ranked = 64;

/// By distance: every hit goes where as many are nearer as places come before. All pairs are compared,
/// without a branch, eight at a time. Of two that are equally far the first stays first.
void put_by_rank(std::span<const BundleHit> hits, BundleHit* out) {
    // Distances are not negative, so that their bits are in their order.
    alignas(32) std::int32_t distances[most_ranked], ranks[most_ranked];
    const auto count = std::int32_t(hits.size()), padded = (count + 7) / 8 * 8;
    for (std::int32_t i = 0; i < count; ++i)
        distances[i] = std::bit_cast<std::int32_t>(hits[std::size_t(i)].distance);
    for (std::int32_t i = count; i < padded; ++i) distances[i] = 0;
    for (std::int32_t i = 0; i < padded; ++i) ranks[i] = 0;
    for (std::int32_t j = 0; j < count; ++j) {
        const std::int32_t distance = distances[j];
        for (std::int32_t i = 0; i < padded; ++i)
            ranks[i] += distance < distances[i] + (j < i ? 1 : 0) ? 1 : 0;
    }
    for (std::int32_t i = 0; i < count; ++i) out[ranks[i]] = hits[std::size_t(i)];
}

/// Hits by distance that are equally far go by their triangles.
void order_equal(std::span<BundleHit> hits) {
    for (std::size_t i = 1; i < hits.size(); ++i)
        for (std::size_t j = i; j > 0 && is_before(hits[j], hits[j - 1]); --j)
            std::swap(hits[j], hits[j - 1]);
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

/// Hits from `begin` on that may coincide with it.
struct Coincident {
    std::size_t end;
    bool both = false;  ///< fronts and backs
    Coincident(std::span<const BundleHit> hits, std::size_t begin, float tolerance) : end(begin + 1) {
        for (; end < hits.size() && std::fabs(hits[end].distance - hits[begin].distance) <= tolerance; ++end)
            both = both || hits[end].from_behind() != hits[begin].from_behind();
    }
};

void take_turns_from_the_start(std::span<BundleHit> hits, float tolerance) {
    bool front_next = true;
    for (std::size_t begin = 0; begin < hits.size();) {
        const auto [end, both] = Coincident(hits, begin, tolerance);
        if (both) take_turns(hits.subspan(begin, end - begin), front_next);
        front_next = hits[end - 1].from_behind();
        begin = end;
    }
}

void reverse(std::span<BundleHit> hits) {
    std::reverse(hits.begin(), hits.end());
    for (BundleHit& hit : hits) hit.triangle ^= BundleHit::behind_bit;
}

/// Which hit is first of all is not known where the first ones coincide: a leaf, or a body on an open floor
/// that is met from below. Then the other end of the ray tells, if it is better there.
void order_coincident(std::span<BundleHit> hits, float tolerance) {
    const bool mixed_first = Coincident(hits, 0, tolerance).both;
    if (mixed_first) reverse(hits);
    if (mixed_first && !Coincident(hits, 0, tolerance).both) {
        take_turns_from_the_start(hits, tolerance);
        reverse(hits);
        return;
    }
    if (mixed_first) reverse(hits);
    take_turns_from_the_start(hits, tolerance);
}

/// What neighbours in order of distance ask for. Without branches, which would mostly be mispredicted.
struct Neighbours {
    bool equal = false;       ///< two are equally far
    bool coincident = false;  ///< a front and a back within the tolerance
    Neighbours(std::span<const BundleHit> hits, float tolerance) {
        for (std::size_t i = 1; i < hits.size(); ++i) {
            const float gap = hits[i].distance - hits[i - 1].distance;
            equal = equal | (gap == 0.0f);
            coincident =
                coincident | ((gap <= tolerance) & (hits[i].from_behind() != hits[i - 1].from_behind()));
        }
    }
};

void put_sorted(std::span<const BundleHit> hits, BundleHit* out, float tolerance) {
    if (hits.size() == 1) {
        *out = hits[0];
        return;
    }
    const std::span<BundleHit> sorted(out, hits.size());
    if (hits.size() <= most_ranked) {
        put_by_rank(hits, out);
    } else {
        std::copy(hits.begin(), hits.end(), out);
        std::sort(sorted.begin(), sorted.end(), is_before);
    }
    const Neighbours neighbours(sorted, tolerance);
    if (neighbours.equal && hits.size() <= most_ranked) order_equal(sorted);
    if (neighbours.coincident) order_coincident(sorted, tolerance);
}

/// How many are left, in front.
std::uint32_t merge(std::span<BundleHit> hits, float distance) {
    std::uint32_t kept = 1, side = hits[0].triangle & BundleHit::behind_bit;
    float last = hits[0].distance;
    for (std::size_t i = 1; i < hits.size(); ++i) {
        const BundleHit hit = hits[i];
        const std::uint32_t its_side = hit.triangle & BundleHit::behind_bit;
        const bool keeps = (its_side != side) | (hit.distance - last > distance);
        hits[kept] = hit, kept += std::uint32_t(keeps);
        side = its_side, last = keeps ? hit.distance : last;
    }
    return kept;
}

}  // namespace

OrderedBand HitBand::ordered(std::uint32_t rays, const HitOrder& order) {
    OrderedBand band;
    band.counts.assign(rays, 0);
    for (const Found& found : found_) ++band.counts[found.ray];
    next_.resize(rays);
    std::uint32_t sum = 0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) next_[ray] = sum, sum += band.counts[ray];
    by_ray_.resize(found_.size());
    for (const Found& found : found_) by_ray_[next_[found.ray]++] = found.hit;
    in_order_.resize(found_.size());
    BundleHit *out = in_order_.data(), *in = by_ray_.data();
    for (std::uint32_t& count : band.counts) {
        if (count == 0) continue;
        put_sorted({in, count}, out, order.coincident);
        in += count;
        if (order.merged > 0.0f) count = merge({out, count}, order.merged);
        out += count;
    }
    band.hits.assign(in_order_.data(), out);
    return band;
}

}  // namespace mote::gathering
