// Settings of mote_micro_rendering.
#pragma once

#include "core/render/integrator.h"
#include "gathering/stored_light/lit_points.h"
#include "integrators/eye_path/eye_path_parameters.h"

namespace mote::integrators {

struct MicroSettings {
    EyePathLimits eye;  ///< max_depth counts the whole path from light to eye
    gathering::LitPointSettings points;
    gathering::MicroBufferSettings buffers;
    std::optional<std::uint32_t> paths;  ///< light paths a pass; nothing: 256 of VPLs, 100,000 of photons
    std::optional<float> bound;          ///< between virtual point lights and points [1/m^2]; 0: none
    int upsampling = 1;                  ///< n: receivers at one pixel of n x n
    bool glossy_upsampling = false;      ///< glossy receivers, too, share their light with neighbours

    /// Limits the bounces of points and their light paths to those of the eye's paths.
    void limit_bounces();
    /// Throws InputError for media, and for points beyond the memory budget.
    void check(bool media) const;
    /// Bounces of light before a receiver that the eye sees directly; -1: no limit.
    int max_bounces() const { return eye.max_depth < 0 ? -1 : std::max(0, eye.max_depth - 2); }
};

const core::ParameterList<MicroSettings>& micro_parameters();

/// Passes of `mote_micro_rendering`: fresh points with fresh light each, shared by all pixels. Precondition:
/// the scene has no media.
std::unique_ptr<core::Estimator> make_micro_estimator(const core::Scene& scene,
                                                      const core::RenderOptions& options,
                                                      const MicroSettings& settings);

}  // namespace mote::integrators
