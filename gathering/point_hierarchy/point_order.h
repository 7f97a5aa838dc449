// The order of points in which a complete binary tree over them has small, flat nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "gathering/surface_points/surfels.h"

namespace mote::gathering {

/// Surfel of each leaf, by cuts at the median of the longest side, over and over (Engelhardt 2013,
/// Sec. 8.1.1). Points that face along the same axis follow each other, so that the two sides of a wall, and
/// walls that meet, are nodes of their own.
std::vector<std::uint32_t> point_order(const Surfels& surfels);

}  // namespace mote::gathering
