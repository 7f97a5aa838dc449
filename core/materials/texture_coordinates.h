// Where on a surface a texture is looked up: coordinates, and for values that a mesh carries, the triangle.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/math/vec.h"

namespace mote::core {

/// Values that a shape carries for its vertices or faces, by name ("vertex_color", "face_color").
class SurfaceAttributes {
  public:
    virtual ~SurfaceAttributes() = default;
    /// True when there is one of that name.
    virtual bool has_attribute(std::string_view name) const = 0;
    /// At a point of a triangle, given by the weights of its second and third corner; grey where one number
    /// was stored. Black when there is none of that name.
    virtual Rgb attribute(std::string_view name, std::uint32_t primitive, const Vec2& barycentric) const = 0;
    /// Weighted by area.
    virtual Rgb attribute_mean(std::string_view name) const = 0;
    /// Smallest and largest channel anywhere.
    virtual Vec2 attribute_range(std::string_view name) const = 0;
};

/// The coordinates (u, v) themselves, together with the point of the shape that they belong to. Coordinates
/// alone suffice for textures other than mesh_attribute and volume.
struct TextureCoordinates : Vec2 {
    const SurfaceAttributes* attributes = nullptr;  ///< of the shape, or null
    std::uint32_t primitive = 0;
    Vec2 barycentric{0, 0};
    Vec3 position{0, 0, 0};  ///< in the world [m]; filled by texture_place(), not by shapes

    TextureCoordinates() : Vec2(0.0f) {}
    TextureCoordinates(const Vec2& uv) : Vec2(uv) {}
    TextureCoordinates(float u, float v) : Vec2(u, v) {}
};

}  // namespace mote::core
