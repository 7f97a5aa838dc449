// The open cylinder: in its own space the unit circle along z from 0 to 1; any affine map of it in the world.
#include <algorithm>
#include <numbers>

#include "core/geometry/quadric.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

/// Arc lengths around an ellipse across the axis, so that points can be sampled uniformly by area. Exact for
/// a circle; else the angle is interpolated by cubics whose slopes are right, in 256 parts.
class ArcLengths {
  public:
    ArcLengths(const Vec3d& x, const Vec3d& y, const Vec3d& z)
        : across_x_(glm::cross(x, z)), across_y_(glm::cross(y, z)) {
        sums_[0] = 0.0;
        for (std::size_t i = 0; i < parts; ++i) {
            double part = 0.0;  // Gauss-Legendre with three points
            for (const auto& [at, weight] :
                 {std::pair(0.5 - std::sqrt(0.15), 5.0), {0.5, 8.0}, {0.5 + std::sqrt(0.15), 5.0}})
                part += weight / 18.0 * speed((double(i) + at) * step);
            sums_[i + 1] = sums_[i] + part * step;
        }
    }
    /// Area of the strip between angles 0 and 2 pi.
    double total() const { return sums_[parts]; }
    /// The angle below which a fraction u of the area lies.
    double angle(double u) const {
        const double target = u * total();
        const auto above = std::upper_bound(sums_.begin() + 1, sums_.end() - 1, target);
        const auto i = std::size_t(above - sums_.begin()) - 1;
        const double length = sums_[i + 1] - sums_[i], s = (target - sums_[i]) / length;
        const double a0 = double(i) * step, slope0 = length / speed(a0), slope1 = length / speed(a0 + step);
        const double s2 = s * s, s3 = s2 * s;  // cubic Hermite
        const double moved = (3.0 * s2 - 2.0 * s3) * step + (s3 - 2.0 * s2 + s) * slope0 + (s3 - s2) * slope1;
        return a0 + std::clamp(moved, 0.0, step);
    }

  private:
    static constexpr std::size_t parts = 256;
    static constexpr double step = 2.0 * std::numbers::pi / double(parts);
    /// Area per angle.
    double speed(double angle) const {
        return glm::length(std::cos(angle) * across_y_ - std::sin(angle) * across_x_);
    }

    Vec3d across_x_, across_y_;
    std::array<double, parts + 1> sums_;
};

class Cylinder final : public AnalyticShape {
  public:
    Cylinder(const Vec3d& p0, const Vec3d& p1, double radius, const Transform& to_world, bool flip_normals)
        : outside_(flip_normals ? -1.0 : 1.0) {
        if (!to_world.valid()) throw InputError("the transform of a cylinder is singular or not finite");
        const Vec3d axis = glm::normalize(p1 - p0), side = Vec3d(Frame(Vec3(axis)).s);
        const Vec3d across = glm::normalize(side - axis * glm::dot(side, axis));
        base_ = to_world.point(p0), z_ = to_world.vector(p1 - p0);
        x_ = radius * to_world.vector(across), y_ = radius * to_world.vector(glm::cross(axis, across));
        const double least = std::fmin(glm::length(x_), std::fmin(glm::length(y_), glm::length(z_)));
        const double reach = glm::length(base_) + glm::length(x_) + glm::length(y_) + glm::length(z_);
        if (!(radius > 0.0) || !(least > 1e-18) || !(reach < 1e18))
            throw InputError("the cylinder's radius and length must be positive, and it within 1e18");
        to_local_ = glm::inverse(glm::dmat3(x_, y_, z_));
        arcs_ = std::make_unique<ArcLengths>(x_, y_, z_);
        if (!(float(arcs_->total()) > 0.0f)) throw InputError("the area of the cylinder is out of range");
    }

    Transform unit_to_world() const override { return affine(x_, y_, z_, base_); }
    LineHits line_hits(const Vec3& origin, const Vec3& direction) const override {
        const Vec3d o = to_local_ * (Vec3d(origin) - base_), d = to_local_ * Vec3d(direction);
        const LineHits round = intersect_round(glm::dvec2(o), glm::dvec2(d), 1.0);
        LineHits hits;
        for (int i = 0; i < round.count; ++i) {
            const double t = round.t[std::size_t(i)], z = o.z + t * d.z;
            if (z >= 0.0 && z <= 1.0) hits.add(t);
        }
        return hits;
    }
    void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const override {
        const Vec3d p = to_local_ * (Vec3d(origin) + double(t) * Vec3d(direction) - base_);
        const glm::dvec2 n = glm::normalize(glm::dvec2(p));
        const Vec3d around = 2.0 * std::numbers::pi * (n.x * y_ - n.y * x_);
        fill_quadric_hit(point(n, p.z), normal(n), {around, z_}, texture_coordinates(n, p.z), *this, hit);
        hit.t = t;
    }
    Bounds3 bounds() const override {
        return outward_bounds(base_ + 0.5 * z_, glm::sqrt(x_ * x_ + y_ * y_) + 0.5 * glm::abs(z_));
    }
    float area() const override { return float(arcs_->total()); }
    bool closed() const override { return false; }

    ShapeSample sample_area(const Vec2& u) const override {
        const double phi = arcs_->angle(double(u.y)), z = double(u.x);
        const glm::dvec2 n(std::cos(phi), std::sin(phi));
        return quadric_sample(point(n, z), normal(n), texture_coordinates(n, z), 1.0 / double(area()));
    }

  private:
    Vec3d point(const glm::dvec2& n, double z) const { return base_ + n.x * x_ + n.y * y_ + z * z_; }
    Vec3d normal(const glm::dvec2& n) const {
        return outside_ * glm::normalize(glm::transpose(to_local_) * Vec3d(n, 0.0));
    }
    static Vec2 texture_coordinates(const glm::dvec2& n, double z) {
        return {turns(n.x, n.y), float(std::fmin(1.0, std::fmax(0.0, z)))};
    }

    Vec3d base_, x_, y_, z_;  ///< centre of the first end, two radii across, and the whole axis
    glm::dmat3 to_local_;
    std::unique_ptr<ArcLengths> arcs_;
    double outside_;
};

}  // namespace

std::shared_ptr<AnalyticShape> make_cylinder(const Vec3d& p0, const Vec3d& p1, double radius,
                                             const Transform& to_world, bool flip_normals) {
    return std::make_shared<Cylinder>(p0, p1, radius, to_world, flip_normals);
}

}  // namespace mote::core
