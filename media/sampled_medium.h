// A medium from any function of a point: its extinction is looked up at the voxels of a grid once, and
// interpolated.
#pragma once

#include <functional>
#include <memory>

#include "core/math/bounds.h"
#include "media/heterogeneous_medium.h"

namespace mote::media {

/// The extinction [1/m] at a point of the world; never negative.
using ExtinctionFunction = std::function<float(const core::Vec3&)>;

/// The medium within `box` [m], vacuum outside, from `resolution` voxels along each axis, trilinear between
/// their centres. `albedo` of one scattering is in [0, 1]; `phase` null: isotropic. Throws InputError for
/// values that are negative or not finite, an empty box, or a resolution below 1.
std::shared_ptr<core::Medium> sampled_medium(const ExtinctionFunction& extinction, const core::Bounds3& box,
                                             int resolution, const core::Rgb& albedo = core::Rgb(0.0f),
                                             std::shared_ptr<core::PhaseFunction> phase = nullptr);

}  // namespace mote::media
