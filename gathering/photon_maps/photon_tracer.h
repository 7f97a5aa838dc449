// Photons from light paths (lights/virtual_lights/light_path.h): one at every vertex with a smooth BSDF or in
// a medium.
//
// Memory is bounded: where a set would grow beyond `max_photons`, every photon is kept with one chance 2^-n
// and carries 2^n times its power. n follows from the number of photons met, not from which ones were kept,
// so the set stays unbiased.
#pragma once

#include <vector>

#include "gathering/photon_maps/photon.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::gathering {

struct PhotonSettings {
    lights::LightPathSettings paths;                ///< how many, and how long
    int first_on_surface = 2, first_in_medium = 2;  ///< depth of the first vertex that leaves a photon
    /// On surfaces and in media together: more are thinned.
    std::size_t max_photons = std::size_t(1) << 23;
};

/// Photons of one set of light paths.
struct PhotonSet {
    std::vector<Photon> surface;      ///< on surfaces
    std::vector<Photon> volume;       ///< in media
    std::uint64_t met = 0;            ///< photons before thinning
    int halvings = 0;                 ///< n
    core::RayCounters rays;           ///< that were traced
    core::TrackingCounters tracking;  ///< queries of media
};

/// Traces in parallel. (seed, pass, path index) determines every path; the order of the photons does not
/// depend on threads. Throws core::Cancelled.
PhotonSet trace_photons(const core::LitScene& scene, const PhotonSettings& settings, std::uint64_t seed,
                        std::uint32_t pass, core::SamplerKind sampler, core::CancelToken cancelled = {});

}  // namespace mote::gathering
