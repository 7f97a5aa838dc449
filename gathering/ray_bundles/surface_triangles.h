// The surfaces of a scene as one list of triangles: what ray-bundles run through, and what an atlas is made
// of.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

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
    core::Bounds3 bounds;

    std::size_t size() const { return corners.size(); }
};

}  // namespace mote::gathering
