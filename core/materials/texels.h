// The pixels of a texture in as little memory as holds them without loss.
//
// Pictures of 8 bits have at most 256 values of a channel, those of 16 bits and of half floats 65,536: each
// number is then kept as its index among the values that occur, in one byte or two instead of four. A grey
// picture keeps one number a pixel instead of three. What is read back has the very bits of the bitmap.
#pragma once

#include <cstdint>
#include <vector>

#include "core/film/bitmap.h"

namespace mote::core {

class Texels {
  public:
    /// Precondition: bitmap.pixels holds width times height pixels.
    explicit Texels(const Bitmap& bitmap);

    /// Pixel x of row y.
    Rgb operator()(int x, int y) const {
        const std::size_t i = std::size_t(y) * width_ + std::size_t(x);
        if (grey_) return Rgb(number(i));
        return {number(3 * i), number(3 * i + 1), number(3 * i + 2)};
    }
    std::size_t bytes() const;  ///< memory of the pixels

  private:
    float number(std::size_t i) const {
        if (!bytes_.empty()) return values_[bytes_[i]];
        return words_.empty() ? values_[i] : values_[words_[i]];
    }

    std::size_t width_;
    bool grey_;
    std::vector<float> values_;         ///< those that occur, or, without indices, of every pixel
    std::vector<std::uint8_t> bytes_;   ///< indices, where there are at most 256 values
    std::vector<std::uint16_t> words_;  ///< indices, where there are at most 65,536
};

}  // namespace mote::core
