// The directions in which a sphere is seen from a point: a cone around the centre, or every direction from
// inside.
//
// The quantity that spherical lights need is the cone's solid angle over the area of the sphere's disc,
// Omega / (pi r^2): with sin(a) = r/d it is 2 / (d^2 (1 + cos(a))), which has no r in a denominator and
// becomes 1/d^2 for a point. A test of membership by sines keeps its precision in cones of any width.
#pragma once

#include "core/math/frame.h"
#include "core/math/warp.h"

namespace mote::compensation {

class SphereCone {
  public:
    /// `radius` >= 0 [m]. A sphere of radius 0 at the point itself has no direction and gives no light.
    SphereCone(const core::Vec3& from, const core::Vec3& centre, float radius) {
        const core::Vec3d to = core::Vec3d(centre) - core::Vec3d(from);
        const double d2 = glm::dot(to, to), r2 = double(radius) * double(radius);
        constexpr double least = 1e-30;  // keeps the densities below finite in single precision
        inside_ = d2 <= r2;
        if (inside_) {
            per_disc_ = r2 > least ? float(4.0 / r2) : 0.0f;
        } else {
            const double sin2 = r2 / d2, one_plus_cos = 1.0 + std::sqrt(1.0 - sin2);
            sin2_ = float(sin2), one_minus_cos_ = float(sin2 / one_plus_cos);
            per_disc_ = float(2.0 / (std::fmax(d2, least) * one_plus_cos));
        }
        if (d2 > 0.0) distance_ = float(std::sqrt(d2)), frame_ = core::Frame(core::Vec3(to / std::sqrt(d2)));
        radius_ = radius;
    }

    bool inside() const { return inside_; }
    const core::Vec3& axis() const { return frame_.n; }  ///< unit, towards the centre
    float solid_angle() const { return 2.0f * core::pi * one_minus_cos_; }
    /// Omega / (pi r^2) [1/m^2], also where r = 0.
    float solid_angle_per_disc() const { return per_disc_; }

    /// Uniform in solid angle, density 1 / solid_angle().
    core::Vec3 sample(const core::Vec2& u) const {
        return glm::normalize(frame_.to_world(core::square_to_cone(u, one_minus_cos_)));
    }
    bool contains(const core::Vec3& w) const {
        if (inside_) return true;
        const core::Vec3 c = glm::cross(frame_.n, w);
        return glm::dot(frame_.n, w) > 0.0f && glm::dot(c, c) <= sin2_;
    }
    /// Distance at which a ray in direction `w` of the cone enters the sphere; 0 from inside.
    float entry(const core::Vec3& w) const {
        if (inside_) return 0.0f;
        const core::Vec3 c = distance_ * glm::cross(frame_.n, w);
        return distance_ * glm::dot(frame_.n, w) - core::safe_sqrt(core::sqr(radius_) - glm::dot(c, c));
    }

  private:
    core::Frame frame_;
    float distance_ = 0.0f, radius_ = 0.0f;
    float sin2_ = 1.0f, one_minus_cos_ = 2.0f, per_disc_ = 0.0f;
    bool inside_ = false;
};

}  // namespace mote::compensation
