// Positions of the pixels of an image in the film: their own, or those of a subset of the film's pixels.
#pragma once

#include <cstddef>
#include <span>

#include "core/math/vec.h"

namespace mote::core {

class PixelPositions {
  public:
    /// An image of the whole film.
    PixelPositions() = default;
    /// An image with so many columns whose pixels, row by row, are those of the film at `corners` [pixels].
    PixelPositions(std::span<const Vec2> corners, int columns) : corners_(corners), columns_(columns) {}

    /// Upper left corner, in the film, of a pixel of the image [pixels].
    Vec2 corner(int x, int y) const {
        if (corners_.empty()) return {float(x), float(y)};
        return corners_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)];
    }

  private:
    std::span<const Vec2> corners_;
    int columns_ = 0;
};

}  // namespace mote::core
