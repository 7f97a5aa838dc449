// Shapes that stand in a scene many times and in memory once.
//
// A ShapeGroup holds shapes in a space of its own. An instance places all of them in the world; each of its
// shapes is then an InstancedShape, a shape like any other in queries of hits, media and bounds. Only
// the ray tracer uses that they share their triangles.
#pragma once

#include "core/geometry/shape.h"
#include "core/math/transform.h"

namespace mote::core {

class ShapeGroup final : public Object {
  public:
    std::vector<std::shared_ptr<Shape>> shapes;
};

/// Where an instance puts its group: any affine map that can be inverted, mirrored and non-uniform ones too.
class Placement {
  public:
    /// Throws InputError when the transform is singular or not finite, or so in single precision, to which
    /// entries are rounded: Embree inverts and traces that. `where`: in the scene file.
    Placement(std::shared_ptr<const ShapeGroup> group, const Transform& to_world,
              const SourceLocation& where = {});

    const ShapeGroup& group() const { return *group_; }
    const Transform& to_world() const { return to_world_; }
    Vec3d local_point(const Vec3d& p) const { return to_local_.point(p); }
    Vec3d local_vector(const Vec3d& v) const { return to_local_.vector(v); }
    /// Unit normal on the side where `normal` was.
    Vec3d world_normal(const Vec3d& local) const { return glm::normalize(normals_ * local); }
    /// World area over local area around a point with this local unit normal.
    double area_factor(const Vec3d& local_normal) const {
        return determinant_ * glm::length(normals_ * local_normal);
    }
    /// Bound of the distance along its normal of a point in the world from the surface that Embree traces
    /// [m], given the same in the group's space.
    float error(const Vec3& position, const Vec3& normal, float local_error) const;
    /// Distance from the world's origin [m] within which a ray may start so that all its numbers stay below
    /// 1e18 in the group's space; negative where no ray may.
    double max_ray_origin() const;
    const SourceLocation& where() const { return where_; }  ///< of the transform in the scene file

  private:
    std::shared_ptr<const ShapeGroup> group_;
    SourceLocation where_;
    Transform to_world_, to_local_;
    glm::dmat3 normals_;          ///< inverse transpose of the linear part
    double determinant_;          ///< its absolute value
    glm::dmat3 inversion_error_;  ///< see error()
};

/// One shape of a group as one instance places it. It has the materials and media of that shape.
class InstancedShape final : public Shape {
  public:
    /// Throws InputError for a shape with an emitter: as in Mitsuba, lights cannot be instanced.
    InstancedShape(std::shared_ptr<const Placement> placement, std::size_t member);

    const Placement& placement() const { return *placement_; }
    const Shape& original() const { return *placement_->group().shapes[member_]; }
    std::size_t member() const { return member_; }
    /// Carries a hit of the original, found in the group's space, to the world; t stays.
    void to_world(SurfaceHit& hit) const;

    Bounds3 bounds() const override { return bounds_; }
    /// Exact for meshes; under non-uniform maps of other shapes a quadrature of 64 x 64 points.
    float area() const override;
    /// Uniform by the area of the original: where the map stretches the surface unevenly, pdf_area says so.
    ShapeSample sample_area(const Vec2& u) const override;
    float pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const override;
    bool closed() const override { return original().closed(); }
    std::size_t primitive_count() const override { return original().primitive_count(); }
    const SurfaceAttributes* attributes() const override { return original().attributes(); }

  private:
    std::shared_ptr<const Placement> placement_;
    std::size_t member_;
    Bounds3 bounds_;
};

/// All shapes of the group as placed by `to_world`. Throws InputError, see Placement and InstancedShape.
std::vector<std::shared_ptr<Shape>> place_group(std::shared_ptr<const ShapeGroup> group,
                                                const Transform& to_world, const SourceLocation& where = {});

/// Result of <shape type="instance">: the loader puts its shapes into the scene.
class Instance final : public Object {
  public:
    std::vector<std::shared_ptr<Shape>> shapes;
};

}  // namespace mote::core
