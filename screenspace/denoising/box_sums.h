// Means over windows of a picture.
#pragma once

#include <span>
#include <vector>

namespace mote::screenspace {

/// Sums over windows of (2 radius + 1)^2 pixels, cut off at the border, with the same bits for any number of
/// threads.
std::vector<float> box_sums(int width, int height, std::span<const float> values, int radius);

}  // namespace mote::screenspace
