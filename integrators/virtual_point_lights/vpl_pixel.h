// Results of the eye paths of `mote_vpl`: light, and receivers for shadow maps.
#pragma once

#include "integrators/eye_path/transport_layers.h"
#include "lights/imperfect_shadow_maps/imperfect_visibility.h"
#include "lights/shadow_maps/shadow_map_gather.h"

namespace mote::integrators {

/// One estimate of a pixel.
struct VplPixel {
    TransportSum transport;
    std::array<core::Rgb, 2> compensation{};  ///< by lights::ReceiverKind

    void add(const VplPixel& other, float weight) {
        for (std::size_t i = 0; i < transport.light.size(); ++i)
            transport.light[i] += weight * other.transport.light[i];
        for (std::size_t i = 0; i < 2; ++i) compensation[i] += weight * other.compensation[i];
    }
};

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
