// Upper bound and importance of a cluster of VPLs for sixteen receivers, or clusters of receivers.
//
// Both are products of the energy of the cluster, the weights of a lane and, for each lane, f* and C* of both
// ends over d^2, where every factor is at its largest over the cluster:
//   d from the box of the differences of positions;
//   a cosine to an axis n is at most  max n.(y - x) / d,  in the box, and that to any axis of a cone around n
//   is at most the cosine of the angle less the cone's;
//   f* is constant, or Henyey-Greenstein's function at such a cosine, or Bsdf::eval_bound().
#pragma once

#include "core/math/lanes.h"
#include "lights/selection/hierarchy/light_node.h"
#include "lights/selection/hierarchy/receiver_bounds.h"

namespace mote::lights {

/// At least the sum over the VPLs j of the cluster of  f*(x) min(G*(x,y_j), b) I_j  for every receiver x of a
/// lane: a third of any channel, and the average of the channels, are below this. `bound`: b [1/m^2],
/// infinity for none. Infinite where no bound is known.
core::Lanes upper_bound(const LightNode& node, const ReceiverBounds& receivers, float bound);

/// Estimate of its light, for choosing among clusters: 0 only where no light can arrive, and finite. The
/// distance is that of the middles, and at least half the diagonal of the cluster.
core::Lanes importance(const LightNode& node, const ReceiverBounds& receivers, float bound);

/// upper_bound() and importance() at once.
void bound_and_importance(const LightNode& node, const ReceiverBounds& receivers, float bound,
                          core::Lanes& most, core::Lanes& about);

}  // namespace mote::lights
