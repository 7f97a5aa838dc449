// Parameters of eye paths that every method reads from a scene file.
#pragma once

#include "core/parameters/add_type.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

/// max_depth, rr_depth and hide_emitters: `within(&Settings::eye, eye_path_rows())`.
const core::ParameterList<EyePathLimits>& eye_path_rows();

}  // namespace mote::integrators
