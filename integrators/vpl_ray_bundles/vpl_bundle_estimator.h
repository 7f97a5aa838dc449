// The passes of `mote_vpl_ray_bundles`: fresh light paths and directions each, which all pixels share, or all
// pixels of one place in blocks of n x n.
#pragma once

#include "core/render/integrator.h"
#include "integrators/vpl_ray_bundles/vpl_bundle_settings.h"

namespace mote::integrators {

/// Precondition: the scene has no media.
std::unique_ptr<core::Estimator> make_vpl_bundle_estimator(const core::Scene& scene,
                                                           const core::RenderOptions& options,
                                                           const VplBundleSettings& settings);

}  // namespace mote::integrators
