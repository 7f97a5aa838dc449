// Sphere, disk and cylinder as exact quadrics: intersected in double precision in their own unit space.
#pragma once

#include "core/geometry/shape.h"
#include "core/math/transform.h"

namespace mote::core {

/// A shape that is intersected by a formula instead of triangles.
class AnalyticShape : public Shape {
  public:
    /// The nearest hit with t in (t_min, t_max), or nothing.
    virtual std::optional<float> intersect(const Vec3& origin, const Vec3& direction, float t_min,
                                           float t_max) const = 0;
    /// Fills everything of a hit from the point reached at distance t.
    virtual void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const = 0;
    std::size_t primitive_count() const override { return 1; }
};

/// Sphere: centre and radius after the transform, which must be a similarity. flip_normals turns the outside
/// in.
std::shared_ptr<AnalyticShape> make_sphere(const Vec3d& center, double radius, const Transform& to_world,
                                           bool flip_normals);
/// Unit disk in the xy plane facing +z, under any affine transform.
std::shared_ptr<AnalyticShape> make_disk(const Transform& to_world, bool flip_normals);
/// Open cylinder of the given radius from p0 to p1; the transform must be a similarity. Normals point
/// outwards.
std::shared_ptr<AnalyticShape> make_cylinder(const Vec3d& p0, const Vec3d& p1, double radius,
                                             const Transform& to_world, bool flip_normals);

}  // namespace mote::core
