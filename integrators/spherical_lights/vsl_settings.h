// Settings of `mote_vsl`.
#pragma once

#include "compensation/spherical_lights.h"
#include "core/render/integrator.h"
#include "integrators/eye_path/light_path_limits.h"

namespace mote::integrators {

struct VslSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 256;
    compensation::SphericalGather gather;

    lights::LightPathSettings light_paths(const core::MemoryBudget& memory = {}) const {
        return light_path_settings(paths, eye, memory);
    }
};

/// The passes of `mote_vsl`: a fresh set of light paths each. Precondition: the scene has no media.
std::unique_ptr<core::Estimator> make_vsl_estimator(const core::Scene& scene,
                                                    const core::RenderOptions& options,
                                                    const VslSettings& settings);

}  // namespace mote::integrators
