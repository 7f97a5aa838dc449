// Where summed areas are looked up to count the pixels of an item: its region set, rectangles each with a
// colour channel in which the item's pixels are painted there (Engelhardt 2013, Sec. 6.1.3).
//
// An item that was given a channel as a whole has one rectangle. The rectangle of a conflict item is split by
// the rectangles of others that overlap it, each part takes a channel that is free there, and neighbouring
// parts that can have the same are merged. Parts that the octagon does not reach are dropped. Where no
// channel is free, or the part would be one too many, two items share one channel: both count the pixels of
// both, never fewer.
#pragma once

#include <vector>

#include "screenspace/visibility/item_bounds.h"

namespace mote::screenspace {

struct RegionSettings {
    int channels = 4;         ///< 1 to 16; a texture has four
    int max_rectangles = 64;  ///< that an item is split into, before they are merged; 1: none is
};

struct Region {
    PixelRectangle rectangle;
    std::uint8_t channel = 0;
};

class RegionSets {
  public:
    /// Bounds of every item, cut at the frame of the picture. Throws std::invalid_argument where settings are
    /// out of range.
    RegionSets(std::span<const ItemBounds> bounds, const PixelRectangle& frame,
               const RegionSettings& settings);

    std::size_t size() const { return sets_.size(); }
    /// Disjoint, from left to right; together they hold every pixel that the bounds do.
    std::span<const Region> of(std::size_t item) const {
        return std::span(regions_).subspan(sets_[item].first, sets_[item].count);
    }
    int channels() const { return channels_; }
    std::size_t regions() const { return regions_.size(); }
    std::size_t conflicts() const { return conflicts_; }  ///< items without a channel of their own
    std::size_t shared() const { return shared_; }        ///< regions without one

  private:
    struct Set {
        std::size_t first = 0, count = 0;
    };
    int channels_;
    std::vector<Set> sets_;
    std::vector<Region> regions_;
    std::size_t conflicts_ = 0, shared_ = 0;
};

}  // namespace mote::screenspace
