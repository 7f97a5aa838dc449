// Shapes: triangle meshes and a few analytic primitives, in world space.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/rounding.h"
#include "core/materials/texture_coordinates.h"
#include "core/math/bounds.h"
#include "core/math/direction_cone.h"
#include "core/math/frame.h"
#include "core/objects/error.h"
#include "core/objects/object.h"

namespace mote::core {

class Bsdf;
class Emitter;
class Medium;
class Shape;

/// First surface on a ray. `position` lies on the shape up to rounding; leave it through offset_origin().
struct SurfaceHit {
    float t = 0.0f;                  ///< distance along the ray [m]
    Vec3 position{0, 0, 0};          ///< on the shape [m]
    Vec3 geometric_normal{0, 0, 1};  ///< unit; the side it points to is the shape's outside
    Frame shading;                   ///< n is the interpolated normal, on the geometric normal's side
    TextureCoordinates uv;           ///< where textures are looked up
    const Shape* shape = nullptr;    ///< that was hit
    /// Derivatives of the position by the texture coordinates [m]; only where Shape::tangent_matters.
    Vec3 dp_du{0.0f}, dp_dv{0.0f};
    std::uint32_t primitive = 0;  ///< triangle index; 0 for analytic shapes
    float error = 0.0f;  ///< how far along the normal rounding can put `position` off the surface [m]
};

/// A point sampled on a shape.
struct ShapeSample {
    Vec3 position;          ///< on the shape [m]
    Vec3 normal;            ///< geometric, unit
    TextureCoordinates uv;  ///< where textures are looked up
    float pdf_area;         ///< [1/m^2]
    float error = 0.0f;     ///< as SurfaceHit::error
};

/// A surface with its material, and what lies on its two sides.
class Shape : public Object {
  public:
    std::shared_ptr<Bsdf> bsdf;                  ///< how it scatters; not null in a scene
    std::shared_ptr<Emitter> emitter;            ///< area light, or null
    std::shared_ptr<Medium> interior, exterior;  ///< behind and before it; null: vacuum
    SourceLocation exterior_where;               ///< where the scene file names the exterior
    bool has_medium_boundary =
        false;  ///< interior or exterior was named (vacuum counts when the other is named)
    /// Such a boundary with a border, as a window of a room: it parts the outside of all closed shapes.
    bool parts_the_outside = false;
    /// The BSDF is anisotropic: the shading frame's s then follows dp/du, and hits have both derivatives.
    /// Otherwise any frame will do.
    bool tangent_matters = false;
    std::uint32_t index = 0;         ///< position in Scene::shapes
    std::vector<std::string> notes;  ///< repairs at load, e.g. "12 degenerate triangles dropped"

    /// Holds every point of it [m].
    virtual Bounds3 bounds() const = 0;
    /// Holds all geometric normals.
    virtual DirectionCone normals() const { return DirectionCone::all(); }
    /// Max distance of its points from bounds().center() in this direction (unit) [m]; by default that of the
    /// box.
    virtual float support(const Vec3& direction) const {
        return 0.5f * glm::dot(glm::abs(direction), bounds().diagonal());
    }
    /// Area of its surface [m^2].
    virtual float area() const = 0;
    /// Uniform by area.
    virtual ShapeSample sample_area(const Vec2& u) const = 0;
    /// Samples a point for lighting `p`: uniform by area unless the shape has a better density (a sphere
    /// samples its cone). The density is returned per solid angle at p in pdf_solid_angle.
    virtual std::optional<ShapeSample> sample_visible(const Vec3& p, const Vec2& u,
                                                      float& pdf_solid_angle) const;
    /// Density of sample_visible() for the point `hit` seen from p in direction wi, per solid angle.
    virtual float pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const;
    /// True when the surface has no border, so that inside and outside are defined.
    virtual bool closed() const = 0;
    virtual std::size_t primitive_count() const = 0;
    /// Values that the shape carries for its vertices or faces, or null.
    virtual const SurfaceAttributes* attributes() const { return nullptr; }
};

/// The origin for a ray leaving a hit.
inline Vec3 offset_origin(const SurfaceHit& hit, const Vec3& direction) {
    return offset_origin(hit.position, hit.geometric_normal, hit.error, direction);
}

}  // namespace mote::core
