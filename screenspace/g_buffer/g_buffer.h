// G-buffer: the surface at each pixel centre as plain buffers, row by row from the top.
//
// Screen-space methods read these buffers and nothing else of the scene. Sources other than primary rays fill
// them directly: every buffer has width * height entries. Several layers are a depth peeling: layer k holds
// the k-th surface along the ray of each pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "core/materials/texture_coordinates.h"
#include "core/math/ray.h"
#include "core/math/vec.h"

namespace mote::core {
class Camera;
class RayQueries;
class Shape;
struct SurfaceHit;
}  // namespace mote::core

namespace mote::screenspace {

struct GBuffer {
    int width = 0, height = 0;  ///< [pixels]

    std::vector<float> distance;       ///< along the ray to the surface [m]; infinity where it misses
    std::vector<core::Vec3> position;  ///< [m]; zero where the ray misses, as all of the following
    std::vector<core::Vec3> geometric_normal, shading_normal;  ///< unit, turned to the viewer
    std::vector<core::Vec3> view;        ///< unit, along the ray, away from the viewer; set for misses too
    std::vector<core::Rgb> reflectance;  ///< albedo of the BSDF seen from the viewer, [0, 1]
    std::vector<core::Rgb> reflectance_behind;  ///< albedo of its other side, seen along the ray
    std::vector<float> solid_angle;  ///< of the pixel [sr]; set for misses too; 0 for parallel projections
    std::vector<std::uint8_t> hit;   ///< 1 where there is a surface
    std::vector<std::uint8_t> emissive;        ///< 1 where that surface is a light
    std::vector<const core::Shape*> shape;     ///< with its BSDF; null where there is none or it is not known
    std::vector<core::TextureCoordinates> uv;  ///< texture coordinates of the surface

    GBuffer() = default;
    /// All misses. Throws std::invalid_argument unless both sizes are positive.
    GBuffer(int width, int height);

    /// Index of a pixel.
    std::size_t index(int x, int y) const { return std::size_t(y) * std::size_t(width) + std::size_t(x); }
    /// Width times height.
    std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
    /// Area of the surface behind the pixel, exact for a planar patch: solid angle * distance^2 / cosine
    /// [m^2]. Zero where the ray misses; the cosine is kept above 1e-4.
    float surface_area(std::size_t pixel) const;
};

/// One primary ray through the centre of every pixel, and through the centre of the lens. Boundaries between
/// media are not seen. Film positions are those of the camera: the picture must have the size of its film.
GBuffer make_g_buffer(const core::RayQueries& scene, const core::Camera& camera, int width, int height);

/// The first `count` surfaces along the ray, or as many as there are, into `hits`; distances from its origin.
/// Each search continues from the surface found before as rays of paths do (offset_origin): it meets no
/// surface twice, and loses none that lies farther behind it than rounding moves both.
void peel(const core::RayQueries& scene, const core::Ray& ray, int count,
          std::vector<core::SurfaceHit>& hits);

/// Layers from front to back; the first is make_g_buffer(). No ray is reflected or refracted: behind a mirror
/// or glass is the next surface along the ray. Throws std::invalid_argument unless `layers` is positive.
std::vector<GBuffer> make_g_buffers(const core::RayQueries& scene, const core::Camera& camera, int width,
                                    int height, int layers);

/// Other side of each surface, as seen from behind along the reversed rays.
GBuffer seen_from_behind(GBuffer buffer);

/// Solid angle that pixel (x, y) covers as seen from a camera [sr].
float pixel_solid_angle(const core::Camera& camera, int x, int y);

}  // namespace mote::screenspace
