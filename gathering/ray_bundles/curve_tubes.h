// The tubes of curves cut into triangles, without the round joints and ends of straight ones.
#pragma once

#include "core/geometry/curves.h"
#include "gathering/ray_bundles/triangle_list.h"

namespace mote::core {
class Placement;
}

namespace mote::gathering {

/// Resolution of the tubes.
struct TubeCuts {
    std::vector<std::uint32_t> along;  ///< pieces of each segment
    std::uint32_t around = 0;          ///< sides of the tube
    std::size_t triangles() const;
};

/// So that the tube lies no further off its triangles than this fraction of the curves' extent; eight sides
/// at least, so that thin tubes keep 97 % of their area.
TubeCuts tube_cuts(const core::Curves& curves, float chord_error);

/// Where an instance places them, or as they are (null).
void append_tubes(const core::Curves& curves, const core::Placement* place, const TubeCuts& cuts,
                  TriangleList& list);

}  // namespace mote::gathering
