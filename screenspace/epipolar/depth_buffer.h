// Epipolar sampling of a host's depth buffer: a pinhole camera, a lamp, and the host's own marching.
//
// All is in camera space: x right, y down, z forward [m]. Normals, by which surfaces continue, come
// from the depth buffer.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "screenspace/epipolar/epipolar_sampling.h"

namespace mote::screenspace {

/// Depths of a pinhole camera, and a lamp.
struct DepthBuffer {
    int width = 0, height = 0;     ///< [pixels]
    std::span<const float> depth;  ///< z by pixel [m]; not above 0, or not finite: nothing is there
    double far_distance = 0.0;     ///< end of rays that meet nothing [m], above 0
    double focal_length = 0.0;     ///< [pixels]
    Vec2d centre{0.0};             ///< where the axis meets the picture [pixels]
    core::Vec3d lamp{0.0};         ///< not at the camera [m]
};

/// Radiance that media scatter into the ray through a place of the film [pixels; the middle of the first
/// pixel is (0.5, 0.5)] before a distance [m]: finite. Light that is scattered once has a pole at the lamp,
/// so a lamp on a pixel's centre makes that pixel as bright as the march's step lets it.
using MarchFunction = std::function<core::Rgb(const Vec2d& film, double distance)>;

/// Light of all pixels.
struct DepthBufferLight {
    std::vector<core::Rgb> light;  ///< row by row from the top [W/(m^2 sr)]
    std::uint64_t marched = 0;     ///< calls of the marching function
};

/// Light over the whole picture, from few calls of `march`, in the caller's thread. `lines`: around the whole
/// border. Throws std::invalid_argument for sizes and positions out of range, and where `march` gives
/// radiance that is not finite.
DepthBufferLight light_over(const DepthBuffer& buffer, int lines, const LineSampling& sampling,
                            const MarchFunction& march);

}  // namespace mote::screenspace
