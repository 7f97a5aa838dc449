// Settings of `mote_photon_map`.
#pragma once

#include "core/render/integrator.h"
#include "gathering/photon_maps/photon_tracer.h"
#include "integrators/eye_path/light_path_limits.h"

namespace mote::integrators {

struct PhotonMapSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 100000;
    std::size_t neighbours = 50, max_photons = std::size_t(1) << 23;
    double alpha = 2.0 / 3.0;
    bool single_scattering = false;

    gathering::PhotonSettings photons(const core::MemoryBudget& memory) const {
        gathering::PhotonSettings s;
        s.paths = light_path_settings(paths, eye, memory, 1);
        s.first_in_medium = single_scattering ? 1 : 2;
        s.max_photons = max_photons;
        return s;
    }
};

/// The passes of `mote_photon_map`: a fresh set of photons each, with kernels that shrink from pass to pass.
std::unique_ptr<core::Estimator> make_photon_map_estimator(const core::Scene& scene,
                                                           const core::RenderOptions& options,
                                                           const PhotonMapSettings& settings);
/// The photons of its passes.
std::unique_ptr<core::PointLights> make_photon_point_lights(const core::Scene& scene,
                                                            const core::RenderOptions& options,
                                                            const PhotonMapSettings& settings);

}  // namespace mote::integrators
