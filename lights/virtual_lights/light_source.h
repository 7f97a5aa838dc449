// Where the virtual point lights of a pass come from: light paths of lights sampled by their power, or what
// a derived class begins them at (reflective_shadow_maps/), or reads.
#pragma once

#include <memory>

#include "core/render/plan.h"
#include "lights/virtual_lights/particle_tracer.h"

namespace mote::lights {

class LightSource {
  public:
    /// The scene must outlive it.
    LightSource(const core::LitScene& scene, const LightPathSettings& settings)
        : scene_(scene), settings_(settings) {}
    virtual ~LightSource() = default;
    /// The VPLs of a pass, which seed and pass determine. Throws core::Cancelled.
    virtual VplSet trace(std::uint64_t seed, std::uint32_t pass, core::SamplerKind sampler,
                         core::CancelToken cancelled) const {
        return trace_light_paths(scene_, settings_, seed, pass, sampler, cancelled);
    }
    virtual void plan(core::Plan& plan) const {
        plan.run("light paths", std::to_string(settings_.paths) + " a pass", "a fresh set every pass");
    }

  protected:
    const core::LitScene& scene_;
    LightPathSettings settings_;
};

/// A light path for each texel of maps of size * size texels (reflective_shadow_maps/), and
/// `settings.paths` paths of all other lights.
std::unique_ptr<LightSource> reflective_light_source(const core::LitScene& scene, int size,
                                                     const LightPathSettings& settings);

}  // namespace mote::lights
