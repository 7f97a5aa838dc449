// The passes of `mote_micro_rendering`: fresh points with fresh light each, which all pixels share.
#pragma once

#include "core/render/integrator.h"
#include "integrators/micro_rendering/micro_settings.h"

namespace mote::integrators {

/// Throws InputError for what is not done in media: upsampling, and light by virtual point lights or photons.
std::unique_ptr<core::Estimator> make_micro_estimator(const core::Scene& scene,
                                                      const core::RenderOptions& options,
                                                      const MicroSettings& settings);

}  // namespace mote::integrators
