// Rules for nodes that every walk that fills micro-buffers shares.
#pragma once

#include "gathering/point_hierarchy/point_hierarchy.h"

namespace mote::gathering {

/// Discs are met from behind beyond this many radii only: a receiver on a convex surface lies below the discs
/// of its neighbours.
inline constexpr float near_back = 1.0f;
/// A node is a disc where its normals lie within this cosine of their mean; others are entered.
inline constexpr float flat_cosine = 0.8f;
/// Distance in the concentric square, of side 1, of directions that are a small angle apart, at most and over
/// the angle: both maps stretch by 0.81, and the angle is up to 0.5.
inline constexpr float square_reach = 0.86f;

/// Sine of the cone's half angle; more than any where the cone is wider than a hemisphere.
inline float cone_sine(const PointNode& node) {
    return node.cone_cos > 0.0f ? core::safe_sqrt(1.0f - node.cone_cos * node.cone_cos) : 2.0f;
}

}  // namespace mote::gathering
