// The passes of `mote_vpl`: a fresh set of light paths each, gathered at the eye path of every pixel, with
// the compensation that the settings select.
#pragma once

#include "core/render/integrator.h"
#include "integrators/virtual_point_lights/vpl_settings.h"

namespace mote::integrators {

std::unique_ptr<core::Estimator> make_vpl_estimator(const core::Scene& scene,
                                                    const core::RenderOptions& options,
                                                    const VplSettings& settings);

}  // namespace mote::integrators
