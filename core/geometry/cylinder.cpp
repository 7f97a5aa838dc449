// The open cylinder: a circle in the plane across its axis, cut off at both ends.
#include <numbers>

#include "core/geometry/quadric.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

class Cylinder final : public AnalyticShape {
  public:
    Cylinder(const Vec3d& p0, const Vec3d& p1, double radius, const Transform& to_world, bool flip_normals)
        : outside_(flip_normals ? -1.0 : 1.0) {
        const double scale = similarity_scale(to_world, "cylinder");
        base_ = to_world.point(p0);
        radius_ = radius * scale;
        length_ = glm::length(p1 - p0) * scale;
        if (!(radius_ > 1e-18) || !(length_ > 1e-18) || !(glm::length(base_) + length_ + radius_ < 1e18))
            throw InputError("the cylinder's radius and length must be positive, and it within 1e18");
        const Vec3d axis = glm::normalize(p1 - p0);
        const Vec3d side = Vec3d(Frame(Vec3(axis)).s);
        z_ = glm::normalize(to_world.vector(axis));
        const Vec3d x = to_world.vector(side);
        x_ = glm::normalize(x - z_ * glm::dot(x, z_));
        y_ = glm::cross(z_, x_) * (to_world.determinant() < 0.0 ? -1.0 : 1.0);
    }

    LineHits line_hits(const Vec3& origin, const Vec3& direction) const override {
        const Vec3d o = local(Vec3d(origin) - base_), d = local(Vec3d(direction));
        const LineHits round = intersect_round(glm::dvec2(o), glm::dvec2(d), radius_);
        LineHits hits;
        for (int i = 0; i < round.count; ++i) {
            const double t = round.t[std::size_t(i)], z = o.z + t * d.z;
            if (z >= 0.0 && z <= length_) hits.add(t);
        }
        return hits;
    }
    void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const override {
        const Vec3d p = local(Vec3d(origin) + double(t) * Vec3d(direction) - base_);
        const glm::dvec2 n = glm::normalize(glm::dvec2(p));
        const Vec3d around = n.x * y_ - n.y * x_;
        fill_quadric_hit(point(n, p.z), normal(n), around, texture_coordinates(n, p.z), *this, hit);
        hit.t = t;
    }
    Bounds3 bounds() const override {
        const Vec3d rim = radius_ * glm::sqrt(x_ * x_ + y_ * y_);
        const Vec3d half_axis = 0.5 * length_ * z_;
        return outward_bounds(base_ + half_axis, rim + glm::abs(half_axis));
    }
    float area() const override { return float(2.0 * std::numbers::pi * radius_ * length_); }
    bool closed() const override { return false; }

    ShapeSample sample_area(const Vec2& u) const override {
        const double phi = 2.0 * std::numbers::pi * double(u.y), z = double(u.x) * length_;
        const glm::dvec2 n(std::cos(phi), std::sin(phi));
        return quadric_sample(point(n, z), normal(n), texture_coordinates(n, z), 1.0 / double(area()));
    }

  private:
    Vec3d local(const Vec3d& v) const { return {glm::dot(v, x_), glm::dot(v, y_), glm::dot(v, z_)}; }
    Vec3d point(const glm::dvec2& n, double z) const {
        return base_ + radius_ * (n.x * x_ + n.y * y_) + z * z_;
    }
    Vec3d normal(const glm::dvec2& n) const { return outside_ * (n.x * x_ + n.y * y_); }
    Vec2 texture_coordinates(const glm::dvec2& n, double z) const {
        return {turns(n.x, n.y), float(std::fmin(1.0, std::fmax(0.0, z / length_)))};
    }

    Vec3d base_, x_, y_, z_;  ///< centre of the first end, and unit axes (z along the cylinder)
    double radius_ = 0.0, length_ = 0.0, outside_;
};

}  // namespace

std::shared_ptr<AnalyticShape> make_cylinder(const Vec3d& p0, const Vec3d& p1, double radius,
                                             const Transform& to_world, bool flip_normals) {
    return std::make_shared<Cylinder>(p0, p1, radius, to_world, flip_normals);
}

}  // namespace mote::core
