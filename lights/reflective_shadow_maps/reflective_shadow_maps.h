// Reflective shadow maps as a source of virtual point lights (Dachsbacher and Stamminger 2005): what a light
// sees, texel by texel, sends its light on.
//
// A texel's flux is the light's intensity times the solid angle of the texel; of parallel light, irradiance
// times area. Each texel is a light path, whose first ray goes through a random place of the texel and counts
// by the solid angle per area of the map there: so the mean is that of particle tracing, and the paths are
// spread evenly. Maps have the views of shadow maps (shadow_maps/light_shadow_maps.h): point lights, cones
// and parallel light have one. Paths of all other lights are sampled as ever.
#pragma once

#include "lights/shadow_maps/light_shadow_maps.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::lights {

class ReflectiveShadowMaps final : public LightPathStarts {
  public:
    /// Maps of size * size texels for every light that can have one, and `other_paths` paths of all other
    /// lights, where there are any. The scene must outlive it. Throws std::invalid_argument unless size is
    /// positive.
    ReflectiveShadowMaps(const core::LitScene& scene, int size, std::uint32_t other_paths);

    std::size_t maps() const { return maps_.size(); }
    std::uint32_t paths() const { return texels() + other_paths_; }

    /// Paths below paths(): a texel each, then those of other lights.
    std::optional<LightPathStart> start(std::uint32_t path, core::Sampler& sampler) const override;

  private:
    struct Map {
        const core::Emitter* emitter;
        ShadowMapView view;
    };
    std::uint32_t texels() const { return std::uint32_t(maps_.size()) * texels_; }
    std::optional<LightPathStart> of_other_light(core::Sampler& sampler) const;

    const core::LitScene& scene_;
    std::uint32_t texels_;   ///< of one map
    float distance_ = 1.0f;  ///< at which intensities are taken [m]
    std::uint32_t other_paths_;
    std::vector<Map> maps_;
};

}  // namespace mote::lights
