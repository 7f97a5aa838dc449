// Pixels of a film that are rendered again and again: an image with one of them a column, in which every row
// is one more sample of each.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/math/vec.h"

namespace mote::core {

class PixelColumns {
  public:
    PixelColumns() = default;  ///< none: images show the pixels of the film
    PixelColumns(std::vector<Vec2i> pixels, int rows)
        : pixels_(std::make_shared<const std::vector<Vec2i>>(std::move(pixels))), rows_(rows) {}
    bool empty() const { return !pixels_; }
    int columns() const { return pixels_ ? int(pixels_->size()) : 0; }  ///< width of the image
    int rows() const { return rows_; }                                  ///< height of the image
    /// The pixel of the film that (x, y) of the image shows.
    Vec2i at(int x, int y) const { return pixels_ ? (*pixels_)[std::size_t(x)] : Vec2i(x, y); }

  private:
    std::shared_ptr<const std::vector<Vec2i>> pixels_;  ///< copies share them
    int rows_ = 0;
};

}  // namespace mote::core
