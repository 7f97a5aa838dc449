// Light of lights that are sampled, arriving at texels directly: for lights that no ray of a bundle meets
// (points, cones, parallel light), or for all of them.
#pragma once

#include "core/objects/cancellation.h"
#include "core/scene/lit_scene.h"
#include "gathering/radiance_exchange/texel_materials.h"

namespace mote::gathering {

/// One connection of a texel to a light.
struct TexelLightSample {
    core::Vec3 wi;         ///< unit, to the light
    core::Rgb irradiance;  ///< its contribution to the texel's [W/m^2]
};

struct TexelDirectLight {
    std::vector<core::Rgb> irradiance;  ///< by texel [W/m^2]; empty where there is no such light
    /// Samples of glossy texels, `samples` each in the order of TexelMaterials::glossy.
    std::vector<TexelLightSample> glossy;
    int samples = 0;
};

/// `samples` connections a texel, each to a light that `lights` samples for it, from places sampled on the
/// texel where it is a whole cell, else from its position. Numbers are keyed by `key` and the texel.
TexelDirectLight texel_direct_light(const core::LitScene& lights, const SurfaceAtlas& atlas,
                                    const TexelMaterials& materials, int samples, std::uint64_t key,
                                    core::CancelToken cancelled);

}  // namespace mote::gathering
