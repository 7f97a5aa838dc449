// The walk down a point hierarchy for one receiver with a warped buffer.
#pragma once

#include "gathering/micro_buffers/brdf_warp.h"
#include "gathering/micro_buffers/micro_buffers.h"

namespace mote::gathering {

/// `out` holds the nearest hits of all rays, cleared and padded. Nodes are entered whose image in the warped
/// square is larger than the cut; what has no image there, because nothing is reflected, ends a walk.
void walk_warped(const PointHierarchy& hierarchy, const MicroBufferSettings& settings, const BrdfWarp& warp,
                 const RayDirections& rays, const MicroReceiver& receiver, DepthRows out);

}  // namespace mote::gathering
