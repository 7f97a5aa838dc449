// Settings of `mote_vsl`.
#pragma once

#include "compensation/spherical_lights.h"
#include "core/render/integrator.h"
#include "integrators/eye_path/eye_path_limits.h"
#include "lights/virtual_lights/light_path.h"

namespace mote::integrators {

struct VslSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    std::uint32_t paths = 256;
    compensation::SphericalGather gather;

    lights::LightPathSettings light_paths(const core::MemoryBudget& memory = {}) const {
        lights::LightPathSettings s;
        s.memory = memory, s.paths = paths, s.rr_depth = eye.rr_depth;
        s.max_vertices = eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2);
        return s;
    }
};

/// The passes of `mote_vsl`: a fresh set of light paths each. Precondition: the scene has no media.
std::unique_ptr<core::Estimator> make_vsl_estimator(const core::Scene& scene,
                                                    const core::RenderOptions& options,
                                                    const VslSettings& settings);

}  // namespace mote::integrators
