// Settings of mote_ray_bundles.
#pragma once

#include "gathering/radiance_exchange/radiance_exchange.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

struct RayBundleSettings {
    EyePathLimits eye;
    gathering::AtlasSettings atlas{.texel_budget = 1 << 16};
    gathering::ExchangeSettings exchange;
    int eye_samples = 4;  ///< a pixel and pass
};

const core::ParameterList<RayBundleSettings>& ray_bundle_parameters();

}  // namespace mote::integrators
