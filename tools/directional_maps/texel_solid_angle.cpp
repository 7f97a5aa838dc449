#include "tools/directional_maps/texel_solid_angle.h"

#include <algorithm>
#include <array>

namespace mote::tools {

using core::Vec3d;
using Polygon = std::vector<glm::dvec2>;

namespace {

double spherical_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double cosines = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return 2.0 * std::atan2(std::fabs(glm::dot(a, glm::cross(b, c))), cosines);
}

/// The part of a convex polygon where dot(normal, p) >= offset.
Polygon clipped(const Polygon& polygon, const glm::dvec2& normal, double offset) {
    Polygon result;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const glm::dvec2 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        const double da = glm::dot(normal, a) - offset, db = glm::dot(normal, b) - offset;
        if (da >= 0.0) result.push_back(a);
        if ((da > 0.0 && db < 0.0) || (da < 0.0 && db > 0.0)) result.push_back(a + da / (da - db) * (b - a));
    }
    return result;
}

/// The part of the polygon within one octant, signs `s`; `upper` says which half.
double octant_part(const Polygon& quadrant, const glm::dvec2& s, bool upper, double up) {
    const double side = upper ? -1.0 : 1.0;
    std::vector<Vec3d> corners;
    for (const glm::dvec2& p : clipped(quadrant, side * s, side)) {
        const glm::dvec2 a = s * p;  // absolute values
        const double z = (1.0 - a.x - a.y) / up;
        corners.push_back(upper ? Vec3d(a, z) : Vec3d(1.0 - a.y, 1.0 - a.x, z));
    }
    return spherical_polygon(corners);
}

/// The integral of a density f(r) over the part of a rectangle within the unit disc, by Green's theorem: the
/// integral of H(r) = int_0^r f(q) q dq over the angle along the border. `rim` is H(1); along(a, b)
/// integrates H over the straight line from a to b, within the disc.
template <class Along>
double over_disc_part(const Rectangle& r, double rim, const Along& along) {
    const glm::dvec2 nearest = glm::clamp(glm::dvec2(0.0), r.low, r.high);
    if (glm::dot(nearest, nearest) >= 1.0) return 0.0;
    const std::array<glm::dvec2, 4> c{r.low, {r.high.x, r.low.y}, r.high, {r.low.x, r.high.y}};
    const auto angle = [](const glm::dvec2& a, const glm::dvec2& b) {
        return std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
    };
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec2 a = c[k], d = c[(k + 1) % 4] - a;
        // |a + t d| = 1: the part of the line between the solutions lies within the disc, the rest follows
        // the rim.
        const double dd = glm::dot(d, d), half = glm::dot(a, d) / dd;
        const double root = half * half - (glm::dot(a, a) - 1.0) / dd;
        const double reach = root > 0.0 ? std::sqrt(root) : 0.0;
        const double t0 = std::clamp(-half - reach, 0.0, 1.0), t1 = std::clamp(-half + reach, 0.0, 1.0);
        const glm::dvec2 in = a + t0 * d, out = a + t1 * d;
        sum += rim * (angle(a, in) + angle(out, a + d));
        if (t1 > t0) sum += along(in, out);
    }
    return std::max(sum, 0.0);  // rounding, where only a corner lies within
}

}  // namespace

double spherical_polygon(std::span<const Vec3d> corners) {
    double sum = 0.0;
    for (std::size_t k = 2; k < corners.size(); ++k)
        sum += spherical_triangle(corners[0], corners[k - 1], corners[k]);
    return sum;
}

double octahedral_polygon(std::span<const glm::dvec2> corners, double up) {
    double sum = 0.0;
    for (const glm::dvec2& s : {glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(-1, -1), glm::dvec2(1, -1)}) {
        const Polygon half = clipped(Polygon(corners.begin(), corners.end()), {s.x, 0.0}, 0.0);
        const Polygon quadrant = clipped(half, {0.0, s.y}, 0.0);
        sum += octant_part(quadrant, s, true, up) + octant_part(quadrant, s, false, up);
    }
    return sum;
}

double cube_rectangle(const Rectangle& r) {
    const auto from_middle = [](double x, double y) {
        return std::atan2(x * y, std::sqrt(1.0 + x * x + y * y));
    };
    return from_middle(r.high.x, r.high.y) - from_middle(r.low.x, r.high.y) - from_middle(r.high.x, r.low.y) +
           from_middle(r.low.x, r.low.y);
}

double disc_area(const Rectangle& r) {
    return over_disc_part(
        r, 0.5, [](const glm::dvec2& a, const glm::dvec2& b) { return 0.5 * (a.x * b.y - a.y * b.x); });
}

double paraboloid_rectangle(const Rectangle& r) {
    // H = 2 r^2 / (1 + r^2), and r^2 dphi = h dt on a line at distance h from the middle.
    return over_disc_part(r, 1.0, [](const glm::dvec2& a, const glm::dvec2& b) {
        const glm::dvec2 along = glm::normalize(b - a);
        const double h = a.x * along.y - a.y * along.x;
        const double scale = std::sqrt(1.0 + h * h);
        return 2.0 * h / scale *
               (std::atan(glm::dot(b, along) / scale) - std::atan(glm::dot(a, along) / scale));
    });
}

}  // namespace mote::tools
