#include "gathering/ray_bundles/hit_band.h"

#include "core/objects/error.h"

namespace mote::gathering {

void HitBand::grow(std::size_t count) {
    const std::size_t size = this->size();
    if (size + count >= BundleHit::behind_bit)
        throw core::InputError("neighbouring rows of a ray-bundle have more than 2^31 hits");
    found_.resize(std::max<std::size_t>(2 * (size + count), 4096));
    end_ = found_.data() + size, room_end_ = found_.data() + found_.size();
}

OrderedBand HitBand::ordered(std::uint32_t rays, const HitOrder& order) {
    OrderedBand band;
    const std::size_t size = this->size();
    band.counts.assign(rays, 0);
    for (std::size_t i = 0; i < size; ++i) ++band.counts[found_[i].ray];
    next_.resize(rays);
    std::uint32_t sum = 0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) next_[ray] = sum, sum += band.counts[ray];
    if (by_ray_.size() < size) by_ray_.resize(found_.size()), in_order_.resize(found_.size() + 1);
    for (std::size_t i = 0; i < size; ++i)
        by_ray_[next_[found_[i].ray]++] =
            HitKey::of(found_[i].hit.distance, found_[i].hit.from_behind(), std::uint32_t(i));
    std::size_t in = 0, out = 0;
    for (std::uint32_t& count : band.counts) {
        if (count == 0) continue;
        const std::size_t all = count;
        count = order_hits({&by_ray_[in], all}, by_ray_.size() - in, order, found_.data(), &in_order_[out]);
        in += all, out += count;
    }
    band.hits.reserve(out);
    for (std::size_t i = 0; i < out; ++i) band.hits.push_back(found_[in_order_[i].number()].hit);
    return band;
}

}  // namespace mote::gathering
