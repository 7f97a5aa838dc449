// Reflectance and emission of the texels of an atlas.
#pragma once

#include "gathering/atlas/surface_atlas.h"

namespace mote::gathering {

struct TexelMaterial {
    core::Rgb reflectance{0.0f};  ///< of a Lambertian side, the mean over the texel; black for all others
    core::Rgb emission{0.0f};     ///< radiance of an area light along the normal, the mean over the texel
};

struct TexelMaterials {
    std::vector<TexelMaterial> of;  ///< by texel
    /// Texels whose BSDF depends on direction (its part without deltas), in ascending order.
    std::vector<std::uint32_t> glossy;
};

/// Textures are averaged over `samples` x `samples` places of a texel where the BSDF or the light has one.
TexelMaterials texel_materials(const SurfaceAtlas& atlas, int samples = 4);

/// The direction from the side of a texel into the room: its mean shading normal, or the geometric one.
inline core::Vec3 outward(const core::SurfaceHit& hit, SurfaceSide side) {
    return side == SurfaceSide::front ? hit.geometric_normal : -hit.geometric_normal;
}

}  // namespace mote::gathering
