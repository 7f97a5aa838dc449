// Maps that the eye paths of `mote_vpl` look up instead of tracing shadow rays.
#pragma once

#include "lights/imperfect_shadow_maps/imperfect_visibility.h"
#include "lights/shadow_maps/light_shadow_maps.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::integrators {

/// Where shadow maps stand in for shadow rays; all null where they do not.
struct EyeShadowMaps {
    const lights::LightShadowMaps* lights = nullptr;
    lights::ReceiverStore* receivers = nullptr;  ///< takes the receivers instead of their gathering VPLs here
    int column = 0, row = 0;                     ///< pixel of the first lane
    int spacing = 1;                             ///< of the lanes' pixels
    float scale = 1.0f;                          ///< of the light at receivers
    const lights::ImperfectShadowMaps* imperfect = nullptr;  ///< looked up instead of shadow rays to VPLs
};

}  // namespace mote::integrators
