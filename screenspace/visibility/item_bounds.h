// Where on the screen an item can be: a rectangle of pixels, and how far it reaches along the diagonals. An
// octagon, that is, which bounds the silhouette of a bounding volume (Engelhardt 2013, Sec. 6.1.3).
//
// It must hold every pixel that shows the item; a rectangle alone will do.
#pragma once

#include <limits>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

/// Octagon that holds every pixel of an item.
struct ItemBounds {
    PixelRectangle rectangle;  ///< that holds them
    /// Smallest and largest x + y of the pixels.
    int sum0 = std::numeric_limits<int>::min(), sum1 = std::numeric_limits<int>::max();
    /// Smallest and largest x - y.
    int difference0 = std::numeric_limits<int>::min(), difference1 = std::numeric_limits<int>::max();

    /// False only if the octagon has no pixel in `r`, part of its rectangle.
    bool meets(const PixelRectangle& r) const {
        return !r.empty() && r.x0 + r.y0 <= sum1 && r.x1 + r.y1 - 2 >= sum0 &&
               r.x0 - r.y1 + 1 <= difference1 && r.x1 - 1 - r.y0 >= difference0;
    }
};

/// Bounds of an outline that is symmetric about (x, y), from its reach along x, y, x + y and x - y [pixels];
/// pixels count by their middles.
ItemBounds bounds_of_outline(float x, float y, float reach_x, float reach_y, float reach_sum,
                             float reach_difference);

}  // namespace mote::screenspace
