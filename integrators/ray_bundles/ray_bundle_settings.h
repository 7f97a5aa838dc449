// Settings of mote_ray_bundles.
#pragma once

#include "core/render/integrator.h"
#include "gathering/radiance_exchange/radiance_exchange.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

/// Lights sampled for a texel: its noise is averaged by all directions that the texel sends to.
inline constexpr int light_samples = 4;

struct RayBundleSettings {
    EyePathLimits eye;
    gathering::AtlasSettings atlas{.texel_budget = 1 << 16};
    gathering::ExchangeSettings exchange;
    int eye_samples = 4;  ///< a pixel and pass
};

const core::ParameterList<RayBundleSettings>& ray_bundle_parameters();

/// The passes of `mote_ray_bundles`: an exchange along directions of its own each.
std::unique_ptr<core::Estimator> make_ray_bundle_estimator(const core::Scene& scene,
                                                           const core::RenderOptions& options,
                                                           const RayBundleSettings& settings);

}  // namespace mote::integrators
