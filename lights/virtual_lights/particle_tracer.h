// Particle tracing: light paths from the lights through surfaces and media, a VPL at every vertex.
//
// Paths are those of light_path.h; delta surfaces are passed without a VPL. Weights are divided by the number
// of paths, not of VPLs.
#pragma once

#include "lights/virtual_lights/light_path.h"
#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::lights {

/// Start of a path: a particle, and its power over the number of paths [W].
struct LightPathStart {
    const core::Emitter* emitter;   ///< where it begins
    core::EmissionSample emission;  ///< the particle
    core::Rgb power;                ///< over the number of paths [W]
};

/// Begins paths otherwise than by sampling a light by its power.
class LightPathStarts {
  public:
    virtual ~LightPathStarts() = default;
    /// Start of a path, by its index; nothing where it carries no light.
    virtual std::optional<LightPathStart> start(std::uint32_t path, core::Sampler& sampler) const = 0;
};

/// Traces one set of light paths in parallel. (seed, pass, path index) determines every path; the order of
/// the VPLs does not depend on threads. `starts` begins the paths. Throws core::Cancelled.
VplSet trace_light_paths(const core::LitScene& scene, const LightPathSettings& settings, std::uint64_t seed,
                         std::uint32_t pass, core::SamplerKind sampler, core::CancelToken cancelled = {},
                         const LightPathStarts* starts = nullptr);

}  // namespace mote::lights
