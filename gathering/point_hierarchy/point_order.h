// The order of points in which a complete binary tree over them has small, flat nodes.
#pragma once

#include <cstdint>
#include <vector>

#include "gathering/surface_points/surfels.h"

namespace mote::gathering {

enum class PointOrder : std::uint8_t {
    morton,  ///< along Morton curves: quick to make, some nodes reach across a gap of the curve
    median   ///< cut at the median of the longest side (Engelhardt 2013, Sec. 8.1.1), over and over
};

/// order[i] is the place, among the surfels, of leaf i. Points that face along the same axis follow each
/// other, so that the two sides of a wall, and walls that meet, are nodes of their own.
std::vector<std::uint32_t> point_order(const Surfels& surfels, PointOrder order);

}  // namespace mote::gathering
