// A cluster of columns in two (Hasan et al. 2007, splitting).
#pragma once

#include "lights/selection/matrix/column_clusters.h"

namespace mote::lights {

/// Puts the members in order, so that the first n are one part and the others the other, whose costs together
/// are least along the line from the middle of all directions to the one farthest from it. Returns n; 0 where
/// no division is better than none.
std::size_t split_columns(const Columns& columns, std::span<std::uint32_t> members);

}  // namespace mote::lights
