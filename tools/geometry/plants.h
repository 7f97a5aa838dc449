// Leaves, and what grows them: tufts of blades, bushes, hanging vines, trees.
#pragma once

#include "core/math/random.h"
#include "tools/geometry/soup.h"

namespace mote::tools {

/// A leaf or blade from `base` along `direction`, folded along its middle, bending down by `droop` of its
/// length. 4 triangles a joint.
struct Leaf {
    Vec3 base, direction;
    float length, width, droop = 0.2f;
    int joints = 1;
};
void add_leaf(Soup& soup, const Leaf& leaf);

/// A direction, uniform over the sphere.
Vec3 random_direction(core::Rng& rng);

/// Blades out of the origin, as of an agave.
Soup make_tuft(float height, int blades, core::Rng& rng, float detail);
/// Leaves, mostly on the surface of an upright ellipsoid that stands on the origin; the fewer, the larger.
Soup make_bush(float radius, float height, int leaves, core::Rng& rng);
/// Stems that hang from the line a..b and sway, with leaves all along.
void add_vines(Soup& soup, const Vec3& a, const Vec3& b, float length, int stems, int leaves, core::Rng& rng);

/// A tree on the origin: parts "bark" (tapered tubes) and "leaves". `levels` of forks, leaves on the last
/// two.
struct Tree {
    float height = 8.0f;
    int levels = 6, leaves_a_twig = 12;
    float leaf = 0.16f;  ///< length of a leaf
};
Parts make_tree(const Tree& tree, core::Rng& rng);

}  // namespace mote::tools
