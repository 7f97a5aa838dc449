// The walk down a hierarchy of volume points for one receiver.
#pragma once

#include "gathering/volume_points/fog_buffers.h"

namespace mote::gathering {

struct FogWalk {
    const VolumeHierarchy& hierarchy;
    const VolumeLight& light;
    const RayDirections& rays;
    HemisphereMap map;
    float cut;  ///< texels
};

/// Adds to red, green and blue of the scratch, which holds the surfaces' distances and the optical depths.
void walk_fog(const FogWalk& walk, const MicroReceiver& receiver, FogScratch& scratch);

}  // namespace mote::gathering
