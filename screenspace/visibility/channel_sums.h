// Summed-area tables of four channels that count pixels (Crow 1984).
//
// Sums are kept in bands of rows that are so low that they fit into 16 bits: four channels are one number of
// 64 bits, and one addition adds all four. What lies above a band is a row of full numbers, one a band. So a
// table takes 8 bytes a pixel, and bands are filled side by side.
#pragma once

#include <memory>
#include <vector>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

class ChannelSums {
  public:
    static constexpr int channels = 4, max_columns = 65535;

    /// Throws std::invalid_argument where a picture has more columns than `max_columns`.
    ChannelSums(int width, int height);

    int bands() const { return (height_ + band_rows_ - 1) / band_rows_; }
    /// Fills a band. `paint(y, pixels)` calls pixels(begin, end, channel) for what is painted in row y, from
    /// left to right; nothing may overlap.
    template <typename Paint>
    void fill_band(int band, const Paint& paint) {
        for (int y = band * band_rows_; y < std::min(height_, (band + 1) * band_rows_); ++y)
            fill_row(y, [&](const auto& pixels) { paint(y, pixels); });
    }
    /// After the last band.
    void finish();

    /// Painted pixels of a channel within a rectangle, which must lie within the picture.
    std::uint32_t pixels(const PixelRectangle& r, int channel) const {
        return at(r.x1, r.y1, channel) - at(r.x0, r.y1, channel) - at(r.x1, r.y0, channel) +
               at(r.x0, r.y0, channel);
    }

  private:
    template <typename Runs>
    void fill_row(int y, const Runs& runs) {
        std::uint64_t* out = local_.get() + std::size_t(y) * stride_;
        const std::uint64_t* above = y % band_rows_ == 0 ? zeros_.data() : out - stride_;
        std::uint64_t sum = 0;  // of the row so far
        int x = 0;
        const auto advance = [&](int end, std::uint64_t step) {
            for (; x < end; ++x) out[x + 1] = above[x + 1] + (sum += step);
        };
        out[0] = 0;
        runs([&](int begin, int end, int channel) {
            advance(begin, 0);
            advance(end, std::uint64_t(1) << (16 * channel));
        });
        advance(width_, 0);
    }
    /// Sum over the pixels left of column x and above row y.
    std::uint32_t at(int x, int y, int channel) const {
        if (y == 0) return 0;
        const std::size_t band = std::size_t((y - 1) / band_rows_);
        const std::uint64_t local = local_[std::size_t(y - 1) * stride_ + std::size_t(x)];
        return above_band_[(band * stride_ + std::size_t(x)) * channels + std::size_t(channel)] +
               std::uint32_t((local >> (16 * channel)) & 0xffffu);
    }

    int width_, height_, band_rows_;
    std::size_t stride_;
    std::unique_ptr<std::uint64_t[]> local_;  ///< sums from the top of the band on; column 0 is 0
    std::vector<std::uint64_t> zeros_;
    std::vector<std::uint32_t> above_band_;
};

}  // namespace mote::screenspace
