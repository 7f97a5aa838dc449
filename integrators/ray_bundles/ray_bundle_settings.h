// Settings of mote_ray_bundles.
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
    int eye_samples = 4;  ///< a pixel and pass
};

/// Settings of a scene file, checked. Throws InputError.
RayBundleSettings read_ray_bundle_settings(const core::Properties& properties);
/// Rows of the manual page.
std::vector<core::Parameter> ray_bundle_parameters();

}  // namespace mote::integrators
