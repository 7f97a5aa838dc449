// Settings of mote_micro_rendering.
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
    std::optional<float> bound;      ///< between virtual point lights and points [1/m^2]; 0: none
    int upsampling = 1;              ///< n: receivers at one pixel of n x n
    bool glossy_upsampling = false;  ///< glossy receivers, too, share their light with neighbours

    /// Throws InputError for media, and for points beyond the memory budget.
    void check(bool media) const;
    /// Bounces of light before a receiver that the eye sees directly; -1: no limit.
    int max_bounces() const { return eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2); }
};

/// Settings of a scene file, checked. Throws InputError.
MicroSettings read_micro_settings(const core::Properties& properties);
/// Rows of the manual page.
std::vector<core::Parameter> micro_parameters();

}  // namespace mote::integrators
