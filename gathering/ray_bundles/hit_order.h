// The hits of one ray in the order in which light meets them.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "gathering/ray_bundles/ray_bundle.h"

namespace mote::gathering {

/// Tolerances of the order of a ray's hits, beyond their distances [m].
struct HitOrder {
    /// Distance within which hits alternate between front and back, as RayBundle says.
    float coincident = 0.0f;
    /// Distance within which hits from the same side, without one from the other side between them, are
    /// merged into the first; 0: none are.
    float merged = 0.0f;
};

/// Sort key in one number: the distance (not negative, so that its bits are in its order), the side, and the
/// hit's number among those of its band, below 2^31.
struct HitKey {
    std::int64_t bits;

    static HitKey of(float distance, bool from_behind, std::uint32_t number) {
        return {std::int64_t(std::bit_cast<std::uint32_t>(distance)) << 32 | std::int64_t(from_behind) << 31 |
                std::int64_t(number)};
    }
    float distance() const { return std::bit_cast<float>(std::uint32_t(bits >> 32)); }
    std::uint32_t side() const { return std::uint32_t(bits) >> 31; }  ///< 1: from behind
    bool from_behind() const { return side() != 0; }
    std::uint32_t number() const { return std::uint32_t(bits) & 0x7fffffffu; }
    void turn() { bits ^= std::int64_t(1) << 31; }
};

/// A hit of a band of rays; `ray` counts from the band's first.
struct FoundHit {
    std::uint32_t ray;
    BundleHit hit;
};
static_assert(sizeof(FoundHit) == 16);

/// Puts the hits of a ray in order and merges them; those that are left go to `ordered`, which has room for
/// all of them and one more. Equal distances are ordered by the triangles of `found`, by number. Returns how
/// many are left. From `keys` on `readable` may be read, though only keys.size() are this ray's.
std::uint32_t order_hits(std::span<const HitKey> keys, std::size_t readable, const HitOrder& order,
                         const FoundHit* found, HitKey* ordered);

}  // namespace mote::gathering
