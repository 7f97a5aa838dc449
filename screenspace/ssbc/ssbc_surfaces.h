// Input of screen-space bias compensation: one patch of surface per pixel.
//
// Plain buffers, row by row from the top, so that pictures of other renderers can go through it. A pixel
// whose area is zero takes no part: it neither receives nor sends light. That is the sky, and every surface
// without diffuse reflectance: mirrors, glass, black lamps.
#pragma once

#include <vector>

#include "core/math/vec.h"

namespace mote::core {
class Bsdf;
struct BsdfPoint;
}  // namespace mote::core

namespace mote::screenspace {

struct GBuffer;

/// Diffuse reflectance of a BSDF seen from wo (in its local frame), [0, 1]: all of a diffuse one,
/// the base of a plastic, next to nothing of a metal, nothing of a mirror or glass.
core::Rgb diffuse_reflectance(const core::Bsdf& bsdf, const core::BsdfPoint& p, const core::Vec3& wo);

/// One patch a pixel.
struct SsbcSurfaces {
    int width = 0, height = 0;           ///< [pixels]
    std::vector<core::Vec3> position;    ///< [m]
    std::vector<core::Vec3> normal;      ///< unit, turned to the viewer
    std::vector<float> facing;           ///< cosine between the normal and the way to the viewer, [0, 1]
    std::vector<float> area;             ///< of the patch behind the pixel [m^2]; 0: takes no part
    std::vector<core::Rgb> reflectance;  ///< diffuse, [0, 1]

    SsbcSurfaces() = default;
    /// No surface anywhere. Throws std::invalid_argument unless both sizes are positive.
    SsbcSurfaces(int width, int height);
    /// Width times height.
    std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
    /// Enters the patch of a pixel, or nothing when it takes no part: without diffuse reflectance, or where
    /// position, normal or area is not finite. `to_viewer` need not have unit length, nor need the normal,
    /// and it may point away from the viewer.
    void set(std::size_t pixel, const core::Vec3& p, const core::Vec3& n, const core::Vec3& to_viewer,
             float surface_area, const core::Rgb& diffuse_reflectance);
    /// Throws std::invalid_argument unless every buffer has one entry a pixel, every reflectance is in [0,
    /// 1], no area is negative, and position is finite, normal unit and `facing` in [0, 1] wherever the area
    /// is not zero.
    void check() const;
};

/// Patches of what the camera sees. Surfaces that are not Lambertian count with the part of their BSDF that
/// looks the same from everywhere (see the source); without one they take no part.
SsbcSurfaces ssbc_surfaces(const GBuffer& buffer);

}  // namespace mote::screenspace
