// Passes of `mote_micro_rendering`: fresh points with fresh light each, shared by all pixels.
#pragma once

#include "core/render/integrator.h"
#include "integrators/micro_rendering/micro_settings.h"

namespace mote::integrators {

/// Precondition: the scene has no media.
std::unique_ptr<core::Estimator> make_micro_estimator(const core::Scene& scene,
                                                      const core::RenderOptions& options,
                                                      const MicroSettings& settings);

}  // namespace mote::integrators
