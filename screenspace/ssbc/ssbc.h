// Screen-space bias compensation: what a bound on the geometry term took from a picture, found in the picture
// itself (Novak et al. 2011; Engelhardt 2013, Ch. 11).
//
// Reflected light R, the picture without emission, that was rendered with the bound b is R_0 = T L_e + T_b R.
// With T = T_b + T_r it lacks T_r R, and T_r needs nothing but surfaces nearer than b^(-1/2):
//
//   R = R_0 + T_r R = sum_n T_r^n R_0        Engelhardt 2013, Eq. 11.3
//
// N steps add the terms up to T_r^N and lack T_r^(N+1) R. No visibility is tested and no VPL is evaluated.
// What the camera does not see is missing: surfaces behind others, and beyond the borders of the picture. The
// former can be given as hidden sides (ssbc_layers.h). They send light from the first step on and receive it
// as well, for the steps after.
#pragma once

#include <span>
#include <vector>

#include "screenspace/ssbc/ssbc_layers.h"
#include "screenspace/ssbc/ssbc_sum.h"
#include "screenspace/ssbc/ssbc_surfaces.h"
#include "screenspace/ssbc/ssbc_upsampling.h"

namespace mote::screenspace {

/// Settings of the compensation.
struct SsbcSettings {
    float bound = 0.0f;  ///< b [1/m^2] that the picture was rendered with; 0: with no indirect light at all
    int steps = 2;       ///< how often T_r is applied, at least once

    bool hierarchical = true;      ///< false: sum over all pixels, for reference; quadratic in their number
    RefinementRules refinement{};  ///< which nodes of the pyramid are summed
    float discontinuity_angle = 0.44f;  ///< [rad] see SurfacePyramid
    /// Pixels whose normal is farther than this from the view send less, quadratically down to nothing at a
    /// right angle: they are long strips, which one sample represents badly. pi/2: none do.
    float grazing_angle = 80.0f * core::pi / 180.0f;  ///< [rad]

    bool half_resolution = false;  ///< gather at one pixel of four, see ssbc_upsampling.h
    UpsamplingRules upsampling{};  ///< where pixels are evaluated again
    float blur = 0.0f;  ///< standard deviation of an edge-preserving blur of the result [pixels]; 0: none

    /// Throws std::invalid_argument naming what is out of range.
    void check() const;
};

/// Result of compensate().
struct SsbcResult {
    std::vector<core::Rgb> compensation;  ///< to be added to the picture; zero where pixels take no part
    SumCounts counts;                     ///< over all steps
    std::uint64_t defective = 0;          ///< pixels evaluated again after upsampling, over all steps
    std::uint64_t non_finite = 0;         ///< pixels whose light is not finite: they send none
};

/// `reflected`: radiance that surfaces reflect, direct and indirect, without emission; one entry a pixel. The
/// result depends on nothing but the arguments. Throws std::invalid_argument for sizes and settings out of
/// range.
SsbcResult compensate(const SsbcSurfaces& surfaces, std::span<const core::Rgb> reflected,
                      const SsbcSettings& settings);
/// Compensation with surfaces that the picture does not show; returned for those that it shows.
SsbcResult compensate(const SsbcSurfaces& surfaces, std::span<const core::Rgb> reflected,
                      std::span<const HiddenSide> hidden, const SsbcSettings& settings);

/// Per side and pixel: 1 where light that is sent from there can come to be seen after the steps. Only what
/// they reflect need be known.
std::vector<std::vector<std::uint8_t>> sides_that_matter(const SsbcSurfaces& surfaces,
                                                         std::span<const SsbcSurfaces> hidden,
                                                         const SsbcSettings& settings);

}  // namespace mote::screenspace
