// Where the virtual point lights of a pass come from: light paths that begin at sampled lights, or at the
// texels of their maps (reflective_shadow_maps/), or another program.
#pragma once

#include <memory>

#include "core/render/plan.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::lights {

class LightSource {
  public:
    virtual ~LightSource() = default;
    /// The VPLs of a pass, which seed and pass determine. Throws core::Cancelled.
    virtual VplSet trace(std::uint64_t seed, std::uint32_t pass, core::SamplerKind sampler,
                         core::CancelToken cancelled) const = 0;
    virtual void plan(core::Plan& plan) const = 0;
};

/// Particles of lights sampled by their power. The scene must outlive it.
std::unique_ptr<LightSource> traced_light_source(const core::LitScene& scene,
                                                 const LightPathSettings& settings);

/// A light path for each texel of maps of size * size texels (reflective_shadow_maps/), and
/// `settings.paths` paths of all other lights. The scene must outlive it.
std::unique_ptr<LightSource> reflective_light_source(const core::LitScene& scene, int size,
                                                     const LightPathSettings& settings);

}  // namespace mote::lights
