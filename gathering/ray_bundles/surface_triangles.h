// The surfaces of a scene as one list of triangles: what ray-bundles run through, and what an atlas is made
// of.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/shape.h"
#include "core/math/bounds.h"

namespace mote::gathering {

/// A triangle list in world space; all arrays have one entry a triangle. A triangle's front is the side from
/// which its corners run counter-clockwise, which is the shape's outside.
struct SurfaceTriangles {
    std::vector<std::array<core::Vec3, 3>> corners;  ///< [m]
    std::vector<std::array<core::Vec3, 3>> normals;  ///< shading normals of the corners, unit, on the front
    std::vector<std::array<core::Vec2, 3>> uvs;      ///< texture coordinates of the corners
    std::vector<std::uint32_t> shape;                ///< index into the scene's shapes
    std::vector<std::uint32_t> primitive;            ///< of the shape: SurfaceHit::primitive
    core::Bounds3 bounds;                            ///< of all corners [m]

    std::size_t size() const { return corners.size(); }  ///< triangles
};

/// [m^2].
inline double triangle_area(const std::array<core::Vec3, 3>& corners) {
    const core::Vec3d a(corners[0]);
    return 0.5 * glm::length(glm::cross(core::Vec3d(corners[1]) - a, core::Vec3d(corners[2]) - a));
}

/// Settings of the tessellation of curved shapes.
struct TessellationSettings {
    /// Max distance of a sphere, cylinder, disk or curve from its triangles, as a fraction of its extent.
    float chord_error = 1e-3f;
    std::size_t memory_budget = std::size_t(4) << 30;  ///< [B]
};

/// The triangles of all shapes that stop light: meshes as they are, instances where they are placed (a
/// mirrored one with its second and third corners exchanged), other shapes cut into triangles, with their
/// corners on the surface. What light passes straight (null BSDFs, panes) is left out. Round joints and ends
/// of straight curves are left out too. Throws InputError where the triangles would take more than the
/// budget, saying how much.
SurfaceTriangles surface_triangles(std::span<const std::shared_ptr<core::Shape>> shapes,
                                   const TessellationSettings& settings = {});

}  // namespace mote::gathering
