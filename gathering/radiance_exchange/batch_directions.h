// The directions of an exchange, in batches.
//
// Batches that follow each other must be independent: what one received is sent along the next, and the mean
// of a product is that of its factors only then. One Halton sequence would look in every batch where the last
// one had not. So two sequences take turns, each continuing where it ended.
#pragma once

#include "gathering/ray_bundles/bundle_directions.h"

namespace mote::gathering {

class BatchDirections {
  public:
    BatchDirections(std::uint64_t key, std::uint32_t batch) : key_(key), batch_(batch) {}

    /// Direction i of all, and the offset of its grid.
    BundleSample at(std::uint32_t i) const {
        const std::uint32_t number = i / batch_;
        return bundle_sample(core::hash_keys(key_, number % sequences),
                             std::uint64_t(number / sequences) * batch_ + i % batch_);
    }

  private:
    static constexpr std::uint32_t sequences = 2;
    std::uint64_t key_;
    std::uint32_t batch_;
};

}  // namespace mote::gathering
