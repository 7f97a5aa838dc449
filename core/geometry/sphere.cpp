// The sphere: intersected exactly, and sampled through the cone that it fills as seen from the receiver.
#include <numbers>

#include "core/geometry/quadric.h"
#include "core/math/pdf_conversion.h"
#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

class Sphere final : public AnalyticShape {
  public:
    Sphere(const Vec3d& center, double radius, const Transform& to_world, bool flip_normals)
        : center_(to_world.point(center)),
          radius_(radius * similarity_scale(to_world, "sphere")),
          to_local_(glm::inverse(glm::dmat3(to_world.matrix)) * similarity_scale(to_world, "sphere")),
          outside_(flip_normals ? -1.0 : 1.0) {
        if (!(radius_ > 1e-18) || !(radius_ + glm::length(center_) < 1e18))
            throw InputError("the sphere's radius must be positive, and the sphere within 1e18");
    }

    LineHits line_hits(const Vec3& origin, const Vec3& direction) const override {
        return intersect_round(Vec3d(origin) - center_, Vec3d(direction), radius_);
    }
    void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const override {
        const Vec3d n = glm::normalize(Vec3d(origin) + double(t) * Vec3d(direction) - center_);
        fill_quadric_hit(center_ + radius_ * n, outside_ * n, tangent_matters ? around(n) : Vec3d(0.0),
                         texture_coordinates(n), *this, hit);
        hit.t = t;
    }
    Bounds3 bounds() const override { return outward_bounds(center_, Vec3d(radius_)); }
    float area() const override { return float(4.0 * std::numbers::pi * radius_ * radius_); }
    bool closed() const override { return true; }

    ShapeSample sample_area(const Vec2& u) const override {
        return sample_at(glm::normalize(Vec3d(square_to_sphere(u))), 1.0 / double(area()));
    }
    std::optional<ShapeSample> sample_visible(const Vec3& p, const Vec2& u,
                                              float& pdf_solid_angle) const override;
    float pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const override;

  private:
    /// 1 - cos of the half-angle of the cone around the sphere as seen from p; negative when p is inside.
    double one_minus_cos_max(const Vec3& p) const {
        const Vec3d to_center = center_ - Vec3d(p);
        const double sin2 = radius_ * radius_ / glm::dot(to_center, to_center);
        return sin2 < 1.0 ? sin2 / (1.0 + std::sqrt(1.0 - sin2)) : -1.0;
    }
    Vec2 texture_coordinates(const Vec3d& n) const {
        const Vec3d local = to_local_ * n;
        const double z = std::fmin(1.0, std::fmax(-1.0, local.z));
        return {turns(local.x, local.y), float(std::acos(z)) * inv_pi};
    }
    /// The direction in which u rises: about the sphere's own z axis.
    Vec3d around(const Vec3d& n) const {
        const Vec3d local = to_local_ * n;
        return glm::transpose(to_local_) * Vec3d(-local.y, local.x, 0.0);
    }
    ShapeSample sample_at(const Vec3d& n, double pdf_area) const {
        return quadric_sample(center_ + radius_ * n, outside_ * n, texture_coordinates(n), pdf_area);
    }

    Vec3d center_;
    double radius_;
    glm::dmat3 to_local_;  ///< rotates (and mirrors) a world normal into the sphere's own axes
    double outside_;       ///< 1, or -1 when the normals point inwards
};

std::optional<ShapeSample> Sphere::sample_visible(const Vec3& p, const Vec2& u,
                                                  float& pdf_solid_angle) const {
    const double cone = one_minus_cos_max(p);
    if (cone < 0.0) return Shape::sample_visible(p, u, pdf_solid_angle);
    pdf_solid_angle = cone_pdf(float(cone));
    if (!std::isfinite(pdf_solid_angle)) return std::nullopt;

    const Vec3d to_center = center_ - Vec3d(p);
    const double distance = glm::length(to_center);
    const Vec3d axis = to_center / distance;
    const double h = double(u.x) * cone, sin2 = h * (2.0 - h);  // h = 1 - cos(theta)
    const double phi = 2.0 * std::numbers::pi * double(u.y);
    const Frame frame((Vec3(axis)));
    const Vec3d side = glm::normalize(Vec3d(frame.s) - axis * glm::dot(Vec3d(frame.s), axis));
    const Vec3d around = std::cos(phi) * side + std::sin(phi) * glm::cross(axis, side);
    const Vec3d direction = (1.0 - h) * axis + std::sqrt(sin2) * around;
    // The nearer of the two points where this direction meets the sphere.
    const double half_chord = std::sqrt(std::fmax(0.0, radius_ * radius_ - distance * distance * sin2));
    const double t = (1.0 - h) * distance - half_chord;
    const Vec3d n = glm::normalize(t * direction - to_center);
    ShapeSample sample = sample_at(n, 0.0);
    sample.pdf_area = solid_angle_to_area(pdf_solid_angle, float(t * t), float(half_chord / radius_));
    return sample;
}

float Sphere::pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const {
    const double cone = one_minus_cos_max(p);
    if (cone < 0.0) return Shape::pdf_visible(p, wi, hit);
    // The far side is never sampled from outside.
    const double away = outside_ * double(glm::dot(hit.geometric_normal, wi));
    return away < 1e-4 ? cone_pdf(float(cone)) : 0.0f;
}

}  // namespace

std::shared_ptr<AnalyticShape> make_sphere(const Vec3d& center, double radius, const Transform& to_world,
                                           bool flip_normals) {
    return std::make_shared<Sphere>(center, radius, to_world, flip_normals);
}

}  // namespace mote::core
