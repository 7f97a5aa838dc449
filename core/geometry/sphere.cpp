// The sphere: intersected exactly, and sampled through the cone that it fills as seen from the receiver.
#include <numbers>

#include "core/geometry/quadric.h"
#include "core/math/pdf_conversion.h"
#include "core/math/warp.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

/// Radius of a transformed sphere. Mitsuba's spheres stay spheres under any transform: where it
/// stretches unevenly, their radius grows as lengths along x do.
double radius_factor(const Transform& to_world) {
    if (!to_world.valid()) throw InputError("the transform of a sphere is singular or not finite");
    const auto uniform = similarity_scale(to_world);
    return uniform ? *uniform : glm::length(to_world.vector({1, 0, 0}));
}

class Sphere final : public AnalyticShape {
  public:
    Sphere(const Vec3d& center, double radius, const Transform& to_world, bool flip_normals)
        : center_(to_world.point(center)),
          radius_(radius * radius_factor(to_world)),
          to_local_(glm::inverse(glm::dmat3(to_world.matrix)) * radius_factor(to_world)),
          outside_(flip_normals ? -1.0 : 1.0) {
        if (!(radius_ > 1e-18) || !(radius_ + glm::length(center_) < 1e18))
            throw InputError("the sphere's radius must be positive, and the sphere within 1e18");
        if (!similarity_scale(to_world))
            notes.push_back(
                "the transform does not scale uniformly; as in Mitsuba it stays a sphere, whose radius is "
                "scaled as x is");
    }

    Transform unit_to_world() const override {
        const glm::dmat3 axes = radius_ * glm::inverse(to_local_);
        return affine(axes[0], axes[1], axes[2], center_);
    }
    LineHits line_hits(const Vec3& origin, const Vec3& direction) const override {
        return intersect_round(Vec3d(origin) - center_, Vec3d(direction), radius_);
    }
    void fill_hit(const Vec3& origin, const Vec3& direction, float t, SurfaceHit& hit) const override {
        const Vec3d n = glm::normalize(Vec3d(origin) + double(t) * Vec3d(direction) - center_);
        fill_quadric_hit(center_ + radius_ * n, outside_ * n,
                         tangent_matters ? derivatives(n) : Derivatives{}, texture_coordinates(n), *this,
                         hit);
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
        const Vec3d local = glm::normalize(to_local_ * n);
        const double z = std::fmin(1.0, std::fmax(-1.0, local.z));
        return {turns(local.x, local.y), float(std::acos(z)) * inv_pi};
    }
    /// u goes about the sphere's own z axis, v from its top to its bottom.
    Derivatives derivatives(const Vec3d& n) const {
        const Vec3d local = to_local_ * n;
        const double from_axis = std::hypot(local.x, local.y);
        const glm::dvec2 outwards = from_axis > 0.0 ? glm::dvec2(local) / from_axis : glm::dvec2(1.0, 0.0);
        const glm::dmat3 to_world = radius_ * std::numbers::pi * glm::transpose(to_local_);
        return {to_world * (2.0 * Vec3d(-local.y, local.x, 0.0)),
                to_world * Vec3d(local.z * outwards, -from_axis)};
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
