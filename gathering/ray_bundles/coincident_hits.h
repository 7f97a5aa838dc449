// Hits of a ray that rounding may have exchanged: surfaces that touch.
#pragma once

#include "gathering/ray_bundles/hit_order.h"

namespace mote::gathering {

/// Of hits by distance, those within the tolerance [m] of each other take turns between front and back.
///
/// Which hit is first of all is not known where the first ones coincide: a leaf, or a body on an open floor
/// that is met from below. Then the other end of the ray tells, if it is better there.
void order_coincident(std::span<HitKey> hits, float tolerance);

}  // namespace mote::gathering
