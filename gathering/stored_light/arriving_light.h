// Irradiance at places, from the selected kinds of light: lights themselves, virtual point lights, photons.
//
// All of it runs on the threads of TBB, is the same for any number of them, and throws core::Cancelled.
#pragma once

#include <vector>

#include "core/geometry/ray_counters.h"
#include "core/objects/cancellation.h"
#include "core/scene/lit_scene.h"
#include "gathering/photon_maps/surface_photon_map.h"
#include "gathering/stored_light/light_places.h"
#include "lights/virtual_lights/virtual_point_light.h"

namespace mote::gathering {

/// By place [W/m^2], and what it took.
struct ArrivedLight {
    std::vector<core::Rgb> irradiance;
    core::RayCounters rays;
};

/// Direct light: `samples` lights and as many directions are sampled for every place and weighted by multiple
/// importance sampling, as at the vertices of eye paths (lights/direct_light/direct_light.h). Random numbers
/// are keyed by `key` and the place. Unbiased in scenes without media.
ArrivedLight direct_light_at(const core::LitScene& scene, const LightPlaces& places, int samples,
                             std::uint64_t key, core::CancelToken cancelled);

/// All of the virtual point lights of a set, with min(G*, bound) in place of G* (bound [1/m^2]; infinity: all
/// of it), by shadow rays.
ArrivedLight vpl_light_at(const core::LitScene& scene, const LightPlaces& places, const lights::VplSet& vpls,
                          float bound, core::CancelToken cancelled);

/// The density of photons around each place (Engelhardt 2013, Eq. 4.5): biased by the radius that it takes.
ArrivedLight photon_light_at(const LightPlaces& places, const SurfacePhotonMap& photons,
                             const DensityEstimate& estimate, core::CancelToken cancelled);

}  // namespace mote::gathering
