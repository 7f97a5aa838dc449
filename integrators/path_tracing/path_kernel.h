// One path from the eye: the random walk that `path` and `volpath` share.
//
// Next-event estimation and scattering directions are combined by multiple importance sampling at every
// vertex; distances in media come from delta tracking; Russian roulette ends paths. Unbiased.
//
// With a bound b every path is weighted by min(G*, b)/G* at its second edge counted from the first
// connectable vertex: the edge where a many-light method connects a VPL. The result is the very transport
// that bounded VPLs estimate (Engelhardt 2013, Sec. 10.1.3), by an independent method: what `mote_vpl` is
// tested against.
#pragma once

#include "integrators/eye_path/transport_layers.h"
#include "integrators/path_tracing/equiangular.h"
#include "lights/emitters/direct_light.h"

namespace mote::integrators {

struct PathSettings {
    int max_depth = -1;            ///< edges of a path: 1 emission only, 2 direct light; -1 no limit
    int rr_depth = 5;              ///< Russian roulette from this depth on
    float bound = core::infinity;  ///< b [1/m^2]; infinity: the true transport
    /// Where there are any, these light media by equi-angular sampling instead of next-event estimation at
    /// collisions. Not together with a bound.
    std::shared_ptr<const EquiangularLights> equiangular;
};

/// Radiance along `ray`, by layer. `state` holds the media at its origin.
template <bool Media>
TransportSum trace_path(const core::Scene& scene, const PathSettings& settings, core::Ray ray,
                        core::MediumState state, core::Sampler& sampler, core::WalkContext& context);

}  // namespace mote::integrators
