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

/// How the hits of a ray are put in order beyond their distances [m].
struct HitOrder {
    /// Hits this near to each other take turns between front and back, as RayBundle says.
    float coincident = 0.0f;
    /// Of hits from the same side this near to each other, without one from the other side between them, the
    /// first stands for all; 0: none does.
    float merged = 0.0f;
};

class HitBand {
  public:
    void clear() { found_.clear(); }
    /// `ray` counts from the band's first.
    void add(std::uint32_t ray, const BundleHit& hit) { found_.push_back({ray, hit}); }
    std::size_t size() const { return found_.size(); }
    /// The hits of `rays` rays. The result depends on the hits alone, not on the order of add().
    OrderedBand ordered(std::uint32_t rays, const HitOrder& order);

  private:
    struct Found {
        std::uint32_t ray;
        BundleHit hit;
    };
    std::vector<Found> found_;
    std::vector<BundleHit> by_ray_, in_order_;
    std::vector<std::uint32_t> next_;  // by ray: where its next hit goes
};

}  // namespace mote::gathering
