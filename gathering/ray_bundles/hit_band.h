// Hits of neighbouring rows of a bundle's rays, found in any order, and put in order.
#pragma once

#include <vector>

#include "gathering/ray_bundles/hit_order.h"
#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

/// What one band of rays found, ordered by ray and distance.
struct OrderedBand {
    std::vector<std::uint32_t> counts;  ///< of each ray
    std::vector<BundleHit> hits;
};

class HitBand {
  public:
    /// Where hits go that are found several at a time, each coordinate by itself.
    struct Room {
        std::uint32_t* ray;
        float* distance;
        HitPlace* place;
    };

    void clear() { size_ = 0; }
    /// `ray` counts from the band's first. Throws InputError beyond 2^31 hits.
    void add(std::uint32_t ray, const BundleHit& hit) {
        const Room to = room(1);
        *to.ray = ray, *to.distance = hit.distance, *to.place = {hit.triangle, hit.u16, hit.v16};
        ++size_;
    }
    /// For up to `count` hits more, of which those count that added() is told of.
    Room room(std::size_t count) {
        if (size_ + count > room_) grow(count);
        return {&rays_[size_], &distances_[size_], &places_[size_]};
    }
    void added(std::size_t count) { size_ += count; }
    std::size_t size() const { return size_; }
    /// The hits of `rays` rays. The result depends on the hits alone, not on the order of add().
    OrderedBand ordered(std::uint32_t rays, const HitOrder& order);

  private:
    void grow(std::size_t count);

    std::size_t size_ = 0, room_ = 0;
    std::vector<std::uint32_t> rays_;
    std::vector<float> distances_;
    std::vector<HitPlace> places_;
    std::vector<HitKey> by_ray_, in_order_;
    std::vector<std::uint32_t> next_;  // by ray: where its next hit goes
};

}  // namespace mote::gathering
