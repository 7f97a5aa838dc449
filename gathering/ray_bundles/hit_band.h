// Hits of neighbouring rows of a bundle's rays, found in any order, and put in order.
#pragma once

#include <span>
#include <vector>

#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

/// What one band of rays found, ordered by ray and distance.
struct OrderedBand {
    std::vector<std::uint32_t> counts;  ///< of each ray
    std::vector<BundleHit> hits;
};

class HitBand {
  public:
    void clear() { found_.clear(); }
    /// `ray` counts from the band's first.
    void add(std::uint32_t ray, const BundleHit& hit) { found_.push_back({ray, hit}); }
    std::size_t size() const { return found_.size(); }
    /// The hits of `rays` rays. Two within `tolerance` [m] of each other take turns between front and back,
    /// as RayBundle says. The order depends on the hits alone, not on that of add().
    OrderedBand ordered(std::uint32_t rays, float tolerance);

  private:
    struct Found {
        std::uint32_t ray;
        BundleHit hit;
    };
    /// A hit by its place on the ray: distance first, then triangle.
    struct Placed {
        std::uint64_t key;
        std::uint16_t u16, v16;
    };
    std::vector<Found> found_;
    std::vector<Placed> placed_;       // by ray
    std::vector<std::uint32_t> next_;  // by ray: where its next hit goes
};

}  // namespace mote::gathering
