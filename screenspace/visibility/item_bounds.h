// Where on the screen an item can be: a rectangle of pixels, and how far it reaches along the diagonals. An
// octagon, that is, which stands for the silhouette of a bounding volume (Engelhardt 2013, Sec. 6.1.3).
//
// It must hold every pixel that shows the item; whoever knows no more than a rectangle gives that.
#pragma once

#include <limits>

#include "screenspace/visibility/id_picture.h"

namespace mote::screenspace {

struct ItemBounds {
    PixelRectangle rectangle;
    // Of the pixels: least and largest x + y and x - y.
    int sum0 = std::numeric_limits<int>::min(), sum1 = std::numeric_limits<int>::max();
    int difference0 = std::numeric_limits<int>::min(), difference1 = std::numeric_limits<int>::max();

    /// Does the octagon have a pixel in `r`, part of its rectangle? It may say yes where it has not.
    bool meets(const PixelRectangle& r) const {
        return !r.empty() && r.x0 + r.y0 <= sum1 && r.x1 + r.y1 - 2 >= sum0 &&
               r.x0 - r.y1 + 1 <= difference1 && r.x1 - 1 - r.y0 >= difference0;
    }
};

/// Of an outline that is its own mirror image about (x, y): how far it reaches along x and y, and how far x +
/// y and x - y go. All in pixels, whose middles count.
ItemBounds bounds_of_outline(float x, float y, float reach_x, float reach_y, float reach_sum,
                             float reach_difference);
/// Of a convex outline through these points, or of whatever lies within it; two numbers a point, in pixels.
struct ScreenPoint {
    float x, y;
};
ItemBounds bounds_of_points(std::span<const ScreenPoint> points);

}  // namespace mote::screenspace
