// Curves of pbrt scenes as cubic B-splines, which is what our tubes follow.
#pragma once

#include <string>

#include "core/formats/pbrt/pbrt_files.h"
#include "core/formats/pbrt/pbrt_parameters.h"
#include "core/math/transform.h"

namespace mote::core {

/// Control points and radii of a shape "curve" in the world, in the text format of `bsplinecurve`.
std::string pbrt_curve_text(const PbrtObject& curve, const Transform& to_world, PbrtFiles& files);

}  // namespace mote::core
