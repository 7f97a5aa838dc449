// The passes of the two path tracers: one path per pixel and pass.
#pragma once

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "integrators/eye_path/counters.h"
#include "integrators/path_tracing/path_kernel.h"

namespace mote::integrators {

template <bool Media>
std::unique_ptr<core::Estimator> make_path_estimator(const core::Scene& scene,
                                                     const core::RenderOptions& options,
                                                     const PathSettings& settings);

/// max_depth and rr_depth of a scene file, checked. Throws InputError.
PathSettings read_path_settings(const core::Properties& properties);
/// Their rows in a manual page.
std::vector<core::Parameter> path_parameters();

}  // namespace mote::integrators
