// The settings of mote_ray_bundles.
#pragma once

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "gathering/radiance_exchange/radiance_exchange.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

struct RayBundleSettings {
    EyePathLimits eye;
    gathering::AtlasSettings atlas;
    gathering::ExchangeSettings exchange;
    int light_samples = 4;  ///< a texel and pass
    int eye_samples = 4;    ///< a pixel and pass
    bool final_gathering = false;
};

/// Of a scene file, checked. Throws InputError.
RayBundleSettings read_ray_bundle_settings(const core::Properties& properties);
/// Their rows in the manual page.
std::vector<core::Parameter> ray_bundle_parameters();

}  // namespace mote::integrators
