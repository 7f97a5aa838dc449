#include "gathering/ray_bundles/hit_band.h"

#include "core/objects/error.h"

namespace mote::gathering {

void HitBand::grow(std::size_t count) {
    if (size_ + count >= BundleHit::behind_bit)
        throw core::InputError("neighbouring rows of a ray-bundle have more than 2^31 hits");
    room_ = std::max<std::size_t>(2 * (size_ + count), 4096);
    rays_.resize(room_), distances_.resize(room_), places_.resize(room_);
}

OrderedBand HitBand::ordered(std::uint32_t rays, const HitOrder& order) {
    OrderedBand band;
    band.counts.assign(rays, 0);
    for (std::size_t i = 0; i < size_; ++i) ++band.counts[rays_[i]];
    next_.resize(rays);
    std::uint32_t sum = 0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) next_[ray] = sum, sum += band.counts[ray];
    if (by_ray_.size() < room_) by_ray_.resize(room_), in_order_.resize(room_ + 1);
    for (std::size_t i = 0; i < size_; ++i)
        by_ray_[next_[rays_[i]]++] =
            HitKey::of(distances_[i], places_[i].triangle >= BundleHit::behind_bit, std::uint32_t(i));
    std::size_t in = 0, out = 0;
    for (std::uint32_t& count : band.counts) {
        if (count == 0) continue;
        const std::size_t all = count;
        count = order_hits({&by_ray_[in], all}, by_ray_.size() - in, order, places_.data(), &in_order_[out]);
        in += all, out += count;
    }
    band.hits.reserve(out);
    for (std::size_t i = 0; i < out; ++i) {
        const HitPlace& place = places_[in_order_[i].number()];
        band.hits.push_back({in_order_[i].distance(), place.triangle, place.u16, place.v16});
    }
    return band;
}

}  // namespace mote::gathering
