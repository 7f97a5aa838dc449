// Paths from the eye: the random walk that `path` and `volpath` share, sixteen paths at a time.
//
// Next-event estimation and scattering directions are combined by multiple importance sampling at every
// vertex; distances in media come from delta tracking; Russian roulette ends paths. Unbiased.
//
// With a bound b every path is weighted by min(G*, b)/G* at its second edge counted from the first
// connectable vertex: the edge where a many-light method connects a VPL. The result is the very transport
// that bounded VPLs estimate (Engelhardt 2013, Sec. 10.1.3), by an independent method: what `mote_vpl` is
// tested against.
#pragma once

#include "integrators/eye_path/eye_packet.h"
#include "integrators/path_tracing/equiangular.h"
#include "integrators/path_tracing/guiding_settings.h"
#include "integrators/path_tracing/path_observer.h"

namespace mote::integrators {

struct PathSettings {
    EyePathLimits limits{};
    float bound = core::infinity;  ///< b [1/m^2]; infinity: the true transport
    GuidingSettings guiding{};
    /// Lights, if any, that light media by equi-angular sampling instead of next-event estimation at
    /// collisions. Not together with a bound.
    std::shared_ptr<const EquiangularLights> equiangular{};
};

/// Follows the paths of a packet, which were started, to their ends: Lane::sum is the radiance along each eye
/// ray, by layer.
template <bool Media>
void trace_paths(const core::Scene& scene, const PathSettings& settings, EyePacket<Media>& packet,
                 PathObserver<Media>& observer);
/// Unobserved.
template <bool Media>
void trace_paths(const core::Scene& scene, const PathSettings& settings, EyePacket<Media>& packet) {
    PathObserver<Media> idle;
    trace_paths(scene, settings, packet, idle);
}

}  // namespace mote::integrators
