// Hits of neighbouring rows of a bundle's rays, found in any order, and put in order.
#pragma once

#include <vector>

#include "gathering/ray_bundles/hit_order.h"

namespace mote::gathering {

/// Hits of one band of rays, ordered by ray and distance.
struct OrderedBand {
    std::vector<std::uint32_t> counts;  ///< of each ray
    std::vector<BundleHit> hits;
};

class HitBand {
  public:
    HitBand() = default;
    HitBand(const HitBand&) = delete;
    HitBand& operator=(const HitBand&) = delete;

    void clear() { end_ = found_.data(); }
    /// `ray` counts from the band's first. Throws InputError beyond 2^31 hits.
    void add(std::uint32_t ray, const BundleHit& hit) { *room(1) = {ray, hit}, ++end_; }
    /// Room for `count` more hits; those that added() counts are kept.
    FoundHit* room(std::ptrdiff_t count) {
        if (room_end_ - end_ < count) grow(std::size_t(count));
        return end_;
    }
    void added(int count) { end_ += count; }
    std::size_t size() const { return std::size_t(end_ - found_.data()); }
    /// The hits of `rays` rays. The result depends on the hits alone, not on the order of add().
    OrderedBand ordered(std::uint32_t rays, const HitOrder& order);

  private:
    void grow(std::size_t count);

    std::vector<FoundHit> found_;
    FoundHit *end_ = nullptr, *room_end_ = nullptr;  // of those that count, and of all
    std::vector<HitKey> by_ray_, in_order_;
    std::vector<std::uint32_t> next_;  // by ray: where its next hit goes
};

}  // namespace mote::gathering
