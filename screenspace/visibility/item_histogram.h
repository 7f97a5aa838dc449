// Hierarchical item buffers (Engelhardt 2013, Sec. 6.2): in how many pixels each item is visible, in every
// tile of the screen and of all coarser tilings, counted in one pass over the picture.
//
// Level 0 holds the bins of ItemLayout; a bin of the next level is the sum of 2 x 2 tiles of the same item,
// and level t holds the pixels of the items in the whole picture. Everything is exact. Tile x of 2^t covers
// the columns c with floor(c 2^t / width) = x, so a width that 2^t does not divide gives tiles that differ by
// one.
#pragma once

#include <vector>

#include "screenspace/visibility/id_picture.h"
#include "screenspace/visibility/item_layout.h"

namespace mote::screenspace {

class ItemHistogram {
  public:
    /// Throws std::invalid_argument where picture and size do not fit, and std::out_of_range where a pixel
    /// shows an item that the layout does not have; `no_item` is not counted. Runs on the threads of TBB; the
    /// result is the same for any number of them.
    ItemHistogram(const IdPicture& picture, const ItemLayout& layout);

    const ItemLayout& layout() const { return layout_; }
    int levels() const { return int(levels_.size()); }  ///< t + 1
    /// 4^(t - level) bins an item, one item after the other, the tiles of each row by row.
    std::span<const std::uint32_t> level(int l) const { return levels_[std::size_t(l)]; }

    /// In the whole picture.
    std::uint32_t pixels(std::uint32_t item) const { return levels_.back()[item]; }
    /// In tile (x, y) of 2^(t - level) a side.
    std::uint32_t pixels(std::uint32_t item, int level, int x, int y) const {
        const int shift = layout_.t() - level;
        const std::size_t tile = std::size_t(x) + (std::size_t(y) << shift);
        return levels_[std::size_t(level)][(std::size_t(item) << (2 * shift)) + tile];
    }
    /// Pixels of a tile of level 0; empty where there are more tiles than pixels.
    PixelRectangle tile(int x, int y) const;
    /// The pixels of an item in all tiles of level 0 that a rectangle touches: never less than there are in
    /// the rectangle, and all of them where its sides are those of tiles.
    std::uint32_t pixels_around(std::uint32_t item, const PixelRectangle& rectangle) const;

  private:
    void count(const IdPicture& picture);
    void make_levels();

    ItemLayout layout_;
    int width_, height_;
    std::vector<std::vector<std::uint32_t>> levels_;
};

}  // namespace mote::screenspace
