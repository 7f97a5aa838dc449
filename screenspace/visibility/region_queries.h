// Visibility by summed areas (Engelhardt 2013, Secs. 6.1.1 to 6.1.4): items are painted into colour channels
// by their region sets, and the pixels within any rectangle are sums over few rectangles of one channel each.
//
// Counts are never below the true ones. They are exact for items that share no region with another one.
#pragma once

#include "screenspace/visibility/channel_sums.h"
#include "screenspace/visibility/exact_counts.h"
#include "screenspace/visibility/region_sets.h"

namespace mote::screenspace {

/// Summed areas of the channels, and the region sets of the items.
class RegionQueries {
  public:
    /// One entry of `bounds` an item. Throws std::invalid_argument where sizes or settings do not fit, or a
    /// pixel shows an item outside of its bounds; std::out_of_range where it shows an item without any.
    RegionQueries(const IdPicture& picture, std::span<const ItemBounds> bounds,
                  const RegionSettings& settings = {});

    /// Regions of every item.
    const RegionSets& sets() const { return sets_; }
    /// In the whole picture, and in a rectangle. The item must exist.
    std::uint32_t pixels(std::uint32_t item) const;
    std::uint32_t pixels(const VisibilityQuery& query) const;  ///< in a rectangle

  private:
    void paint(const IdPicture& picture);

    PixelRectangle frame_;
    RegionSets sets_;
    std::vector<ChannelSums> sums_;  ///< of four channels each
};

}  // namespace mote::screenspace
