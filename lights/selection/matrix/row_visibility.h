// Visibility between the receivers of a matrix's rows and VPLs: rays, or a shadow map of each receiver's view
// (as in Hasan et al. 2007).
//
// Maps pay where there are many more lights than texels, most of all in grids of density, where a ray is a
// walk and a lookup is not. They are biased, which moves the probabilities of VPLs and nothing else.
#pragma once

#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

struct RowVisibilitySettings {
    enum class Kind : std::uint8_t { rays, shadow_maps };
    Kind kind = Kind::shadow_maps;
    int map_size = 32;  ///< texels along an edge of a receiver's volumetric map
    ShadowMapSettings map;
};

/// The maps of sixteen receivers; none for rays.
class RowMaps {
  public:
    void build(const core::RayQueries& scene, const ReceiverTile& rows, const RowVisibilitySettings& settings,
               core::CancelToken cancelled);

    /// Multiplies light by V* from the receivers' maps.
    void look_up(const VplSet& vpls, std::span<LaneLight> light) const;
    const core::RayCounters& rays() const { return rays_; }

  private:
    std::array<VolumetricShadowMap, ReceiverLanes::width> maps_;
    core::RayCounters rays_;
};

}  // namespace mote::lights
