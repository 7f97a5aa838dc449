// A global ray-bundle (Sbert 1996): all parallel rays of one direction through a regular grid, and everything
// that each of them meets, in order.
//
// Two hits that follow each other on a ray see each other, along the direction and against it, if the sides
// that they turn towards each other are those that send and receive: this is a link, and it serves both ways.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gathering/ray_bundles/bundle_grid.h"

namespace mote::gathering {

/// Twelve bytes, so that ten million links between closed bodies (two hits each) take less than 300 MB.
struct BundleHit {
    float distance;          ///< from the ray's origin [m]
    std::uint32_t triangle;  ///< index into SurfaceTriangles; the highest bit says: from behind
    std::uint16_t u16, v16;  ///< u() and v() in units of 1 / 65535; their sum is at most 1

    static constexpr std::uint32_t behind_bit = 0x80000000u;           ///< of `triangle`
    std::uint32_t index() const { return triangle & ~behind_bit; }     ///< of the triangle
    bool from_behind() const { return (triangle & behind_bit) != 0; }  ///< was its back hit?
    /// Barycentric: (1 - u - v) c0 + u c1 + v c2.
    float u() const { return float(u16) * (1.0f / 65535.0f); }
    float v() const { return float(v16) * (1.0f / 65535.0f); }  ///< of c2
};
static_assert(sizeof(BundleHit) == 12);

/// The hits of a bundle, ray by ray.
struct RayBundle {
    BundleGrid grid;                   ///< its rays
    std::vector<std::uint32_t> first;  ///< by ray, and one more: hits of ray i are [first[i], first[i + 1])
    /// Hits of each ray by distance. Where surfaces coincide to rounding, fronts and backs alternate, as they
    /// would if nothing were rounded: a body that stands on a floor hides it, and a leaf of two coincident
    /// sides is seen from both.
    std::vector<BundleHit> hits;

    /// Hits of one ray, by distance.
    std::span<const BundleHit> hits_of(std::size_t ray) const {
        return {hits.data() + first[ray], first[ray + 1] - first[ray]};
    }
    /// Memory of the hits [B].
    std::size_t memory_bytes() const {
        return first.capacity() * sizeof(std::uint32_t) + hits.capacity() * sizeof(BundleHit);
    }
};

/// Calls visit(ray, near, far) for every two hits that follow each other and turn sides to each other that
/// send and receive: fronts always, the back of a triangle where uses_back(its index) says so.
template <typename UsesBack, typename Visit>
void for_each_link(const RayBundle& bundle, const UsesBack& uses_back, const Visit& visit) {
    for (std::size_t ray = 0; ray + 1 < bundle.first.size(); ++ray) {
        const auto hits = bundle.hits_of(ray);
        for (std::size_t i = 0; i + 1 < hits.size(); ++i) {
            const BundleHit &near = hits[i], &far = hits[i + 1];
            if ((near.from_behind() || uses_back(near.index())) &&
                (!far.from_behind() || uses_back(far.index())))
                visit(ray, near, far);
        }
    }
}
/// for_each_link() where no back sends or receives.
template <typename Visit>
void for_each_link(const RayBundle& bundle, const Visit& visit) {
    for_each_link(
        bundle, [](std::uint32_t) { return false; }, visit);
}

}  // namespace mote::gathering
