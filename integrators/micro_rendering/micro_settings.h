// The settings of mote_micro_rendering.
#pragma once

#include "core/objects/properties.h"
#include "core/objects/registry.h"
#include "gathering/stored_light/lit_points.h"
#include "integrators/eye_path/eye_path_limits.h"

namespace mote::integrators {

struct MicroSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    gathering::LitPointSettings points;
    gathering::MicroBufferSettings buffers;
    std::optional<float> bound;  ///< of virtual point lights at points [1/m^2]; 0: none, nothing: automatic
    bool warped = true;          ///< buffers of receivers that are not diffuse follow their BSDF
    int upsampling = 1;          ///< n: receivers at one pixel of n x n
    bool glossy_upsampling = false;  ///< glossy receivers, too, share their light with neighbours

    /// Throws InputError for what is not done in this scene, or exceeds the memory budget.
    void check(bool media) const;
    /// Bounces of light before a receiver that the eye sees directly; -1: no limit.
    int most_bounces() const { return eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2); }
};

/// Of a scene file, checked. Throws InputError.
MicroSettings read_micro_settings(const core::Properties& properties);
/// Their rows in the manual page.
std::vector<core::Parameter> micro_parameters();

}  // namespace mote::integrators
