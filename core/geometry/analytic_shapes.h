// Sphere, disk and cylinder as exact quadrics: intersected in double precision in their own unit space.
#pragma once

#include <array>

#include "core/geometry/shape.h"
#include "core/math/transform.h"

namespace mote::core {

/// Where a line meets a shape: at most two distances, in ascending order, in units of the direction's length.
struct LineHits {
    int count = 0;
    std::array<double, 2> t{};
    void add(double distance) { t[std::size_t(count++)] = distance; }
};

/// A shape that is intersected by a formula instead of triangles.
class AnalyticShape : public Shape {
  public:
    /// All hits along the whole line, in double precision. A touching line hits once. The direction need not
    /// have unit length; origins or directions that are not finite hit nothing.
    virtual LineHits line_hits(const Vec3& origin, const Vec3& direction) const = 0;
    /// The nearest hit with t in (t_min, t_max), or nothing.
    std::optional<float> intersect(const Vec3& origin, const Vec3& direction, float t_min,
                                   float t_max) const {
        const LineHits hits = line_hits(origin, direction);
        for (int i = 0; i < hits.count; ++i)
            if (const auto t = float(hits.t[std::size_t(i)]); t > t_min && t < t_max) return t;
        return std::nullopt;
    }
    /// Fills everything of a hit from the point reached at distance t.
    virtual void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const = 0;
    std::size_t primitive_count() const override { return 1; }
    /// From a space of the shape's own, in which it is always the same, to the world.
    virtual Transform unit_to_world() const = 0;
};

/// An affine map by its axes' images and the origin's.
inline Transform affine(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
    return Transform(
        glm::dmat4(glm::dvec4(x, 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0), glm::dvec4(origin, 1.0)));
}

/// Sphere: centre and radius before the transform, which should be a similarity (see notes). flip_normals
/// turns the outside in. All three throw InputError for a transform, a radius or an axis that they cannot
/// take.
std::shared_ptr<AnalyticShape> make_sphere(const Vec3d& center, double radius, const Transform& to_world,
                                           bool flip_normals);
/// Unit disk in the xy plane facing +z, under any affine transform.
std::shared_ptr<AnalyticShape> make_disk(const Transform& to_world, bool flip_normals);
/// Open cylinder of the given radius from p0 to p1 before the transform, any affine one. Normals point
/// outwards.
std::shared_ptr<AnalyticShape> make_cylinder(const Vec3d& p0, const Vec3d& p1, double radius,
                                             const Transform& to_world, bool flip_normals);

}  // namespace mote::core
