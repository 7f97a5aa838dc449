// The disk: a plane, and a point in it in terms of the two images of the unit axes.
#include <numbers>

#include "core/geometry/quadric.h"
#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

class Disk final : public AnalyticShape {
  public:
    Disk(const Transform& to_world, bool flip_normals)
        : center_(to_world.point({0, 0, 0})),
          x_axis_(to_world.vector({1, 0, 0})),
          y_axis_(to_world.vector({0, 1, 0})) {
        if (!to_world.valid()) throw InputError("the transform of a disk is singular or not finite");
        const Vec3d cross = glm::cross(x_axis_, y_axis_);
        const double length = glm::length(cross);
        area_ = std::numbers::pi * length;
        plane_ = cross / length;
        // Coordinates in the plane: dot products with the dual axes.
        x_dual_ = glm::cross(y_axis_, plane_) / length;
        y_dual_ = glm::cross(plane_, x_axis_) / length;
        normal_ = plane_ * ((to_world.determinant() < 0.0) != flip_normals ? -1.0 : 1.0);
        const double reach = glm::length(center_) + glm::length(x_axis_) + glm::length(y_axis_);
        if (!(float(area_) > 0.0f) || !(reach < 1e18))
            throw InputError("the disk's size or place is out of range");
    }

    Transform unit_to_world() const override { return affine(x_axis_, y_axis_, plane_, center_); }
    LineHits line_hits(const Vec3& origin, const Vec3& direction) const override {
        LineHits hits;
        const Vec3d o = Vec3d(origin) - center_, d(direction);
        const double t = -glm::dot(o, plane_) / glm::dot(d, plane_);
        if (!std::isfinite(t)) return hits;
        const Vec3d p = o + t * d;
        const double x = glm::dot(p, x_dual_), y = glm::dot(p, y_dual_);
        if (x * x + y * y <= 1.0) hits.add(t);
        return hits;
    }
    void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const override {
        const Vec3d p = Vec3d(origin) + double(t) * Vec3d(direction) - center_;
        const double x = glm::dot(p, x_dual_), y = glm::dot(p, y_dual_);
        const Vec3d from_center = x * x_axis_ + y * y_axis_;
        const double r = std::hypot(x, y);  // u is the radius, and v the angle in turns
        const Vec3d outwards = r > 0.0 ? from_center / r : x_axis_;
        const Vec3d around = 2.0 * std::numbers::pi * (x * y_axis_ - y * x_axis_);
        fill_quadric_hit(center_ + from_center, normal_, {outwards, around}, texture_coordinates(x, y), *this,
                         hit);
        hit.t = t;
    }
    Bounds3 bounds() const override {
        return outward_bounds(center_, glm::sqrt(x_axis_ * x_axis_ + y_axis_ * y_axis_));
    }
    DirectionCone normals() const override { return DirectionCone::of(Vec3(normal_)); }
    float support(const Vec3& direction) const override {
        const Vec3d d(direction), from_middle = center_ - Vec3d(bounds().center());
        return float(glm::dot(d, from_middle) + std::hypot(glm::dot(d, x_axis_), glm::dot(d, y_axis_)));
    }
    float area() const override { return float(area_); }
    bool closed() const override { return false; }

    ShapeSample sample_area(const Vec2& u) const override {
        const Vec2 d = square_to_disk(u);
        const double x = double(d.x), y = double(d.y);
        return quadric_sample(center_ + x * x_axis_ + y * y_axis_, normal_, texture_coordinates(x, y),
                              1.0 / area_);
    }

  private:
    static Vec2 texture_coordinates(double x, double y) {
        return {std::fmin(1.0f, float(std::sqrt(x * x + y * y))), turns(x, y)};
    }

    Vec3d center_, x_axis_, y_axis_, plane_, x_dual_, y_dual_, normal_;
    double area_ = 0.0;
};

}  // namespace

std::shared_ptr<AnalyticShape> make_disk(const Transform& to_world, bool flip_normals) {
    return std::make_shared<Disk>(to_world, flip_normals);
}

}  // namespace mote::core
