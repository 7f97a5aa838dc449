// What stands between the receivers of a matrix's rows and lights: rays, or maps of what each receiver sees
// (Hasan et al. 2007 have a shadow map for every row).
//
// Maps pay where there are many more lights than texels, most of all in grids of density, where a ray is a
// walk and a lookup is not. They are biased, which moves the probabilities of lights and nothing else.
#pragma once

#include "lights/imperfect_shadow_maps/imperfect_shadow_maps.h"
#include "lights/shadow_maps/volumetric_shadow_map.h"
#include "lights/virtual_lights/vpl_gather.h"

namespace mote::lights {

struct RowVisibilitySettings {
    enum class Kind : std::uint8_t { rays, shadow_maps, imperfect };
    Kind kind = Kind::rays;
    int map_size = 32;  ///< texels along an edge of a receiver's volumetric map
    ShadowMapSettings map;
    ImperfectMapSettings imperfect;
};

/// The maps of sixteen receivers; none for rays.
class RowMaps {
  public:
    /// `points`: of imperfect maps, else null.
    void build(const core::RayQueries& scene, const ReceiverTile& rows, const RowVisibilitySettings& settings,
               const SurfacePoints* points, std::uint64_t key, core::CancelToken cancelled);

    /// V* of lights at the receivers, from their maps, times what `light` holds.
    void look_up(const VplSet& vpls, std::span<LaneLight> light) const;
    const core::RayCounters& rays() const { return rays_; }

  private:
    void look_up_volumetric(const VplSet& vpls, std::span<LaneLight> light) const;
    void look_up_imperfect(const VplSet& vpls, std::span<LaneLight> light) const;

    RowVisibilitySettings::Kind kind_ = RowVisibilitySettings::Kind::rays;
    std::array<VolumetricShadowMap, ReceiverLanes::width> maps_;
    ImperfectShadowMaps imperfect_;
    core::RayCounters rays_;
};

}  // namespace mote::lights
