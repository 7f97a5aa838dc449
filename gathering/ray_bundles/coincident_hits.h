// Hits of a ray that rounding may have exchanged: surfaces that touch.
#pragma once

#include "gathering/ray_bundles/hit_order.h"

namespace mote::gathering {

/// Reorders hits by distance: those within the tolerance [m] of each other alternate between front and back.
void order_coincident(std::span<HitKey> hits, float tolerance);

}  // namespace mote::gathering
