// Everything of a pixel that screen-space sampling leaves at full rate: what the eye sees directly and
// through mirrors and glass, direct light on surfaces, and light scattered once in media that no point-like
// light sent.
//
// Point-like lights are marched along the rays behind mirrors and glass. Along the first ray they are left
// out here, because that is what single_scattering_estimator.h samples in screen space.
#pragma once

#include <span>

#include "core/math/sampler.h"
#include "integrators/eye_path/transport_layers.h"
#include "lights/shadow_maps/light_shadow_maps.h"
#include "screenspace/in_scattering/in_scattering.h"

namespace mote::integrators {

struct EyeSettings {
    int max_depth = 32;  ///< rays of one eye path through mirrors and glass
    float voxels = 1.0f;
    const lights::LightShadowMaps* maps = nullptr;  ///< of lights without a position; null: traced
    bool other_lights =
        true;  ///< some light has no position, or a medium emits: distances are sampled for them
};

struct EyePath {
    TransportSum sum;
    std::optional<core::SurfaceHit> first;  ///< what the first ray meets
};

/// `positional` are the lights that are marched. `state` holds the media at the ray's origin.
template <bool Media>
EyePath trace_eye(const core::Scene& scene, const EyeSettings& settings,
                  std::span<const screenspace::InScattering> positional, core::Ray ray,
                  core::MediumState state, core::Sampler& sampler, screenspace::MarchScratch& scratch);

}  // namespace mote::integrators
