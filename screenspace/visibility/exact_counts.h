// The exact mode of visibility queries: the pixels of an item within any rectangle, for thousands of pairs.
//
// The picture is read once and sorted into runs, pieces of rows that show one item. A query adds up the runs
// of its item within its rows, so it costs no more than the item has runs there, wherever else the picture is
// busy.
#pragma once

#include <vector>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

/// The pixels of an item in a rectangle.
struct VisibilityQuery {
    std::uint32_t item = no_item;  ///< its number
    PixelRectangle rectangle;      ///< what reaches beyond the picture has no pixels
};

/// Runs of pixels by item.
class ExactCounts {
  public:
    /// A picture of items below `items`, or no_item. Throws std::invalid_argument and std::out_of_range as
    /// ItemHistogram does.
    ExactCounts(const IdPicture& picture, std::uint32_t items);

    /// Number of items.
    std::uint32_t items() const { return std::uint32_t(first_.size() - 1); }
    /// Pixels in the whole picture.
    std::uint32_t pixels(std::uint32_t item) const { return pixels_[item]; }
    /// Throws std::out_of_range where there is no such item.
    std::uint32_t pixels(const VisibilityQuery& query) const;
    /// The smallest rectangle that holds all pixels of an item; empty where it is not visible.
    PixelRectangle bounds(std::uint32_t item) const;

  private:
    struct Run {
        std::int32_t y, x0, x1;
    };
    std::vector<std::size_t> first_;  ///< run of each item; the last one is their number
    std::vector<Run> runs_;           ///< of each item from top to bottom, from left to right
    std::vector<std::uint32_t> pixels_;
};

}  // namespace mote::screenspace
