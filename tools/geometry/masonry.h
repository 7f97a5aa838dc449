// Elements of arcades: columns, walls with an arch, groin vaults, balusters, paving.
#pragma once

#include "tools/geometry/soup.h"

namespace mote::tools {

/// A round column on a square plinth, with a moulded base and a capital that goes over from round to square.
/// It stands on the origin and is `height` high to the top of its abacus, which is `abacus` wide.
struct Column {
    float height = 3.6f, radius = 0.25f, abacus = 0.8f;
    float twist = 0.0f;  ///< turns of the fluting over the height; 0: a plain shaft
};
Soup make_column(const Column& column, float detail);

/// A wall over one bay, from a to b at the height of the springing of its arch (a, b have the same y), with a
/// semicircular opening and a ring of wedge-shaped stones that stand out a little.
struct ArchWall {
    Vec3 a, b;
    float top, thickness, radius;
};
/// Goes into parts "wall", and in turn "stone" and "red" for the ring.
void add_arch_wall(Parts& parts, const ArchWall& wall, float detail);

/// A groin vault over the rectangle lower..upper at the height of its springing lower.y, seen from below.
void add_vault(Soup& soup, const Vec3& lower, const Vec3& upper, float rise, float detail);

/// A turned baluster of radius 0.07 on the origin.
Soup make_baluster(float height, float detail);

/// Square flags with bevelled edges on a bed below them; every second one into the other soup. `keep` says
/// where there is paving.
void add_paving(Soup& light, Soup& dark, const Vec3& lower, const Vec3& upper, float size,
                const std::function<bool(float x, float z)>& keep);

}  // namespace mote::tools
