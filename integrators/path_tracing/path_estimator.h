// The passes of the two path tracers: one path per pixel and pass.
#pragma once

#include "integrators/eye_path/eye_path_parameters.h"
#include "integrators/path_tracing/trace_paths.h"

namespace mote::integrators {

template <bool Media>
std::unique_ptr<core::Estimator> make_path_estimator(const core::Scene& scene,
                                                     const core::RenderOptions& options,
                                                     const PathSettings& settings);

}  // namespace mote::integrators
