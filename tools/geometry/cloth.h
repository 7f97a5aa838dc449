// Hanging cloth: curtains in pleats, banners, and sails that sag between two walls. Thin sheets with two
// sides.
#pragma once

#include "core/math/random.h"
#include "tools/geometry/soup.h"

namespace mote::tools {

/// Cloth that hangs `drop` down from the line a..b, in `pleats` waves along it.
struct Hanging {
    Vec3 a, b;
    float drop;
    int pleats;
};
/// Deep pleats, gathered a little at three quarters of the way down.
void add_curtain(Soup& soup, const Hanging& cloth, core::Rng& rng, float detail);
/// Almost flat, pointed below, with the slow waves of a breeze.
void add_banner(Soup& soup, const Hanging& cloth, core::Rng& rng, float detail);
/// A rectangle between the edges lower.z and upper.z, sagging by `sag` in the middle.
void add_sail(Soup& soup, const Vec3& lower, const Vec3& upper, float sag, core::Rng& rng, float detail);

}  // namespace mote::tools
