// Particle tracing: light paths from the lights through surfaces and media, a VPL at every vertex.
//
// Paths are those of light_path.h; delta surfaces are passed without a VPL. Weights are divided by the number
// of paths, not of VPLs.
#pragma once

#include "lights/virtual_lights/light_path.h"
#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::lights {

/// Traces one set of light paths in parallel. (seed, pass, path index) determines every path; the order of
/// the VPLs does not depend on threads. Throws core::Cancelled.
VplSet trace_light_paths(const core::LitScene& scene, const LightPathSettings& settings, std::uint64_t seed,
                         std::uint32_t pass, core::SamplerKind sampler, core::CancelToken cancelled = {});

}  // namespace mote::lights
