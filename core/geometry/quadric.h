// Shared by the quadrics: the stable quadratic, similarity transforms, conservative bounds.
#pragma once

#include <numbers>

#include "core/geometry/analytic_shapes.h"
#include "core/geometry/rounding.h"

namespace mote::core {

/// Solves |f + t d| = r for vectors of two or three components. The discriminant is taken from the point of
/// closest approach (Haines et al. 2019, Eq. 5), so that nothing cancels for origins far away.
template <typename Vec>
LineHits intersect_round(const Vec& f, const Vec& d, double r) {
    LineHits hits;
    const double a = glm::dot(d, d), b = -glm::dot(f, d);
    if (!(a > 0.0) || !std::isfinite(a) || !std::isfinite(b)) return hits;
    const Vec closest = f + (b / a) * d;
    const double inside = r * r - glm::dot(closest, closest);
    if (!(inside >= 0.0)) return hits;
    const double root = std::sqrt(a * inside);
    if (root == 0.0) {
        hits.add(b / a);
        return hits;
    }
    const double q = b + std::copysign(root, b);
    const double distance = std::sqrt(glm::dot(f, f));
    const double t0 = (distance - r) * (distance + r) / q, t1 = q / a;
    hits.add(std::fmin(t0, t1)), hits.add(std::fmax(t0, t1));
    return hits;
}

/// The uniform scale of a similarity (rotation, uniform scale, translation, mirroring), or nothing.
std::optional<double> similarity_scale(const Transform& to_world);

/// Derivatives of a point with respect to its texture coordinates [m].
struct Derivatives {
    Vec3d dp_du{0.0}, dp_dv{0.0};
};
/// Rounds a point of a quadric to single precision and fills everything of a hit but t.
void fill_quadric_hit(const Vec3d& position, const Vec3d& normal, const Derivatives& derivatives,
                      const Vec2& uv, const Shape& shape, SurfaceHit& hit);
ShapeSample quadric_sample(const Vec3d& position, const Vec3d& normal, const Vec2& uv, double pdf_area);

/// Angle of (x, y) around the origin in turns, in [0, 1), as Mitsuba maps it to u.
inline float turns(double x, double y) {
    const double angle = std::atan2(y, x) / (2.0 * std::numbers::pi);
    return std::fmin(float(angle < 0.0 ? angle + 1.0 : angle), one_minus_epsilon);
}

/// The box [centre - half, centre + half] rounded outwards, with room for the rounding of ray distances.
Bounds3 outward_bounds(const Vec3d& center, const Vec3d& half);

}  // namespace mote::core
