// Everything of a pixel that screen-space sampling leaves at full rate: what the eye sees directly and
// through mirrors and glass, direct light on surfaces, and light scattered once in media that no point-like
// light sent.
//
// Point-like lights are marched along the rays behind mirrors and glass. Along the first ray they are left
// out here, because that is what single_scattering_estimator.h samples in screen space.
#pragma once

#include <span>

#include "integrators/eye_path/eye_path_limits.h"
#include "integrators/eye_path/eye_ray.h"
#include "integrators/eye_path/transport_layers.h"
#include "lights/emitters/other_lights.h"
#include "lights/shadow_maps/light_shadow_maps.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::integrators {

struct EyeSettings {
    /// Rays through mirrors and glass, and one that shows what a surface scatters.
    EyePathLimits limits{.max_depth = 33, .rr_depth = 1 << 30, .max_scatterings = 1};
    float voxels = 1.0f;
    const lights::LightShadowMaps* maps = nullptr;  ///< of lights without a position; null: traced
    /// Lights with a position that every vertex is connected to, and all others, one of which is sampled;
    /// where these are null, one of all is sampled.
    std::span<const core::Emitter* const> connected = {};
    const lights::OtherLights* others = nullptr;
    bool other_lights =
        true;  ///< some light has no position, or a medium emits: distances are sampled for them
};

/// One estimate of a pixel.
struct EyeLight {
    TransportSum sum;
    std::optional<core::SurfaceHit> first;  ///< that the first ray meets, behind panes
};

/// `positional` are the lights that are marched. scratch.walk holds the path's generator.
template <bool Media>
EyeLight trace_eye(const core::Scene& scene, const EyeSettings& settings,
                   std::span<const screenspace::InScattering> positional, const EyeRay& eye,
                   screenspace::MarchScratch& scratch);

}  // namespace mote::integrators
