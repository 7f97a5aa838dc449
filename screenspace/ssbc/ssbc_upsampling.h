// Irradiance from a part of the pixels for all of them (Engelhardt 2013, Sec. 11.3; Sloan et al. 2007).
//
// One pixel of every 2 x 2 is evaluated. The others take the mean of up to four of those around, weighted
// by their distance in the picture and by whether they lie on the same surface. Where all weights are nearly
// zero, or where the four are too unlike to represent what lies between, the pixel is defective and has to be
// evaluated itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "screenspace/ssbc/ssbc_surfaces.h"

namespace mote::screenspace {

struct UpsamplingRules {
    float angle = 0.35f;      ///< between normals, and of the joining line to the planes: weight 0 [rad]
    float min_weight = 0.6f;  ///< a sum of weights below is defective; that of one plane is 1
    float contrast = 0.2f;    ///< defective: samples differ by more than this times their mean
};

/// 1 where b continues the plane of a, 0 from `angle` on: pixels of one picture.
float same_surface(const SsbcSurfaces& surfaces, std::size_t a, std::size_t b, float sine_of_angle);

/// The pixels to evaluate at half resolution: the first of every 2 x 2 that takes part.
std::vector<std::uint32_t> half_resolution_pixels(const SsbcSurfaces& surfaces);

/// Fills `irradiance`, which holds values at `evaluated`, at all pixels that take part. Returns the defective
/// ones, along a Z-curve; they are left as they were.
std::vector<std::uint32_t> upsample(const SsbcSurfaces& surfaces, std::span<const std::uint32_t> evaluated,
                                    const UpsamplingRules& rules, std::span<core::Rgb> irradiance);

}  // namespace mote::screenspace
