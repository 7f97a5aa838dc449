#include "lights/emitters/light_cone.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mote::lights {

using namespace core;

std::optional<std::pair<double, double>> inside_cone(const LightCone& cone, const Ray& ray, double t0,
                                                     double t1) {
    if (!(t0 < t1)) return std::nullopt;
    if (cone.angle >= 0.5 * double(pi)) return std::pair(t0, t1);
    // A point x = w + t d, seen from the apex, lies inside where x.a >= |x| cos: a quadratic inequality, and
    // x.a > 0.
    const Vec3d w = Vec3d(ray.origin) - Vec3d(cone.apex), d(ray.direction), axis(cone.axis);
    const double c2 = std::cos(cone.angle) * std::cos(cone.angle), along = glm::dot(w, axis),
                 slope = glm::dot(d, axis);
    const double A = slope * slope - c2 * glm::dot(d, d), B = along * slope - c2 * glm::dot(w, d);
    const double C = along * along - c2 * glm::dot(w, w);
    const auto inside = [&](double t) { return along + t * slope > 0.0 && (A * t + 2.0 * B) * t + C >= 0.0; };

    // Between neighbours of these the answer does not change.
    std::array<double, 5> cuts{t0, t0, t0, t0, t1};
    const auto cut = [&](std::size_t i, double t) {
        cuts[i] = std::isfinite(t) ? std::clamp(t, t0, t1) : t0;
    };
    const double discriminant = B * B - A * C;
    if (discriminant > 0.0) {
        const double q = -(B + std::copysign(std::sqrt(discriminant), B));
        cut(1, q / A), cut(2, C / q);
    }
    cut(3, -along / slope);
    std::sort(cuts.begin(), cuts.end());
    double from = t1, to = t0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double a = cuts[i], b = cuts[i + 1];
        if (!(a < b) || !inside(std::isfinite(b) ? 0.5 * (a + b) : 2.0 * std::abs(a) + 1.0)) continue;
        from = std::min(from, a), to = std::max(to, b);
    }
    if (!(from < to)) return std::nullopt;
    return std::pair(from, to);
}

}  // namespace mote::lights
