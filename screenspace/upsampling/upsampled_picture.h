// Upsampling of a host's whole picture: its surfaces as arrays, and a function that shades a pixel.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "screenspace/upsampling/upsampling.h"

namespace mote::screenspace {

/// First surfaces of a pinhole camera, row by row from the top, in camera space (the camera at 0).
struct SurfacePicture {
    int width = 0, height = 0;             ///< [pixels]
    double focal_length = 0.0;             ///< [pixels]
    std::span<const core::Vec3> position;  ///< [m]; not finite: nothing is there, and no light
    std::span<const core::Vec3> normal;    ///< unit, towards the camera
    std::span<const core::Rgb> albedo;     ///< what light is interpolated without; empty: 1 everywhere
};

/// Light of all pixels.
struct UpsampledPicture {
    std::vector<core::Rgb> light;  ///< row by row from the top
    std::uint64_t shaded = 0;      ///< calls of the shading function
};

/// Radiance of a pixel (column, row).
using ShadeFunction = std::function<core::Rgb(int x, int y)>;

/// Calls `shade` at every `spacing`-th pixel of every `spacing`-th row, and where no neighbour fits, in the
/// caller's thread; interpolates all others. Throws std::invalid_argument for sizes out of range.
UpsampledPicture upsampled(const SurfacePicture& surfaces, int spacing, const ShadeFunction& shade);

}  // namespace mote::screenspace
