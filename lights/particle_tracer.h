// Particle tracing: light paths from the lights through surfaces and media, a VPL at every vertex.
//
// Engelhardt 2013, Sec. 10.1.1 (with the two slips of its step 1 put right, see docs/errata.md):
//   alpha_1     = L_e C*(y0->y1) tau / (p_A(y0) p_w(w0) p(t0))
//   alpha_{i+1} = alpha_i f* C* tau / (q p(w) p(t))
// Distances are sampled by delta tracking, so tau/p(t) is 1 at a surface and sigma_s/sigma_t goes to a volume
// vertex. Delta surfaces are passed without a VPL. Weights are divided by the number of paths, not of VPLs.
#pragma once

#include "lights/virtual_point_light.h"

namespace mote::lights {

struct LightPathSettings {
    std::uint32_t paths = 1024;
    int max_vertices = -1;  ///< vertices on a light path after the light, delta ones included; -1: no limit
    int rr_depth = 5;       ///< Russian roulette after this many vertices
};

/// Traces one set of light paths in parallel. (seed, pass, path index) determines every path; the order of
/// the VPLs does not depend on threads.
VplSet trace_light_paths(const core::Scene& scene, const LightPathSettings& settings, std::uint64_t seed,
                         std::uint32_t pass, core::SamplerKind sampler);

}  // namespace mote::lights
