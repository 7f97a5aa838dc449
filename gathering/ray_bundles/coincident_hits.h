// Hits of a ray that rounding may have exchanged: surfaces that touch.
#pragma once

#include "gathering/ray_bundles/hit_order.h"

namespace mote::gathering {

/// Reorders hits by distance: those within the tolerance [m] of each other alternate between front and back.
///
/// Where the first hits coincide (a leaf, or a body on an open floor that is met from below), which of them
/// is first is unknown: then the order is found from the other end of the ray, unless hits coincide there
/// too.
void order_coincident(std::span<HitKey> hits, float tolerance);

}  // namespace mote::gathering
