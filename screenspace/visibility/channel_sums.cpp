#include "screenspace/visibility/channel_sums.h"

#include <stdexcept>

namespace mote::screenspace {

ChannelSums::ChannelSums(int width, int height)
    : width_(width),
      height_(height),
      // A channel of a band has no more pixels than the band: below 2^16.
      band_rows_(width > 0 ? std::clamp(65535 / width, 1, 64) : 64),
      stride_(std::size_t(width) + 1),
      local_(std::make_unique_for_overwrite<std::uint64_t[]>(stride_ * std::size_t(height))),
      zeros_(stride_) {
    if (width > max_columns) throw std::invalid_argument("summed areas take 65535 columns at most");
}

void ChannelSums::finish() {
    above_band_.assign(std::size_t(std::max(bands(), 1)) * stride_ * channels, 0);
    for (std::size_t b = 1; b < std::size_t(bands()); ++b) {
        const std::uint64_t* last = local_.get() + (b * std::size_t(band_rows_) - 1) * stride_;
        for (std::size_t x = 0; x < stride_; ++x)
            for (std::size_t c = 0; c < channels; ++c)
                above_band_[(b * stride_ + x) * channels + c] =
                    above_band_[((b - 1) * stride_ + x) * channels + c] +
                    std::uint32_t((last[x] >> (16 * c)) & 0xffffu);
    }
}

}  // namespace mote::screenspace
