// The centre line with its derivatives, and the surface around it.
#include "core/geometry/curves.h"

#include <numbers>

#include "core/geometry/mesh_checks.h"
#include "core/geometry/quadric.h"
#include "core/math/pdf_conversion.h"

namespace mote::core {
namespace {

/// Rays that leave a tube must not meet it again. Embree's iteration stops within some 1e-6 of the extent of
/// a segment, as Mitsuba's offset of 9e-5 (1 + |p|) allows for: the largest error seen in 1e6 rays that leave
/// straight tubes of all proportions is 1.2e-6.
constexpr double relative_error = 1e-5;

using Weights = std::array<double, 4>;

Weights spline(double u) {
    const double u2 = u * u, u3 = u2 * u;
    return {(1.0 - 3.0 * u + 3.0 * u2 - u3) / 6.0, (4.0 - 6.0 * u2 + 3.0 * u3) / 6.0,
            (1.0 + 3.0 * u + 3.0 * u2 - 3.0 * u3) / 6.0, u3 / 6.0};
}
Weights spline_slope(double u) {
    const double u2 = u * u;
    return {(-1.0 + 2.0 * u - u2) / 2.0, (-4.0 * u + 3.0 * u2) / 2.0, (1.0 + 2.0 * u - 3.0 * u2) / 2.0,
            u2 / 2.0};
}
Weights spline_bend(double u) { return {1.0 - u, -2.0 + 3.0 * u, 1.0 - 3.0 * u, u}; }

/// Across the tube, at right angles to the line and to each other. `start` is where the texture coordinate
/// around the tube begins: beside the direction that is nearest to z, as in Mitsuba.
struct Cross {
    Vec3d start, next;
    explicit Cross(const Vec3d& tangent) {
        const Vec3d guide = Vec3d(0, 0, 1) - tangent * tangent.z;
        const double length = glm::length(guide);
        next = length > 0.0 ? guide / length : Vec3d(0, 1, 0);
        start = glm::cross(next, tangent);
    }
};

}  // namespace

struct Curves::Point {
    Vec3d center, slope, bend;  ///< the line and its derivatives by the parameter
    double radius, radius_slope;
    Vec3d tangent() const {
        const double length = glm::length(slope);
        return length > 0.0 ? slope / length : Vec3d(1, 0, 0);
    }
    /// Area for each unit of the parameter and radian around, where `radial` points out of the tube.
    double area_element(const Vec3d& radial) const {
        const double length = glm::length(slope);
        const double along = length - radius * glm::dot(radial, bend) / std::fmax(length, 1e-300);
        return radius * std::hypot(along, radius_slope);
    }
};

Curves::Curves(CurveData data) : data_(std::move(data)) {
    const std::size_t order = data_.basis == CurveBasis::linear ? 2 : 4;
    if (data_.segments.empty()) throw InputError("the curve has no segment");
    for (const std::uint32_t first : data_.segments)
        if (data_.points.size() < order || first > data_.points.size() - order)
            throw InputError("a segment of the curve refers to a control point that is not there");
    float widest = 0.0f;
    for (const glm::vec4& p : data_.points) {
        const Vec3 center(p);
        if (!is_finite(center) || !(max_component(glm::abs(center)) + p.w < largest_coordinate))
            throw InputError("a control point of the curve is not finite or lies beyond 1e18");
        if (!(p.w >= 0.0f)) throw InputError("a radius of the curve is negative");
        widest = std::fmax(widest, p.w);
        const Bounds3 ball = outward_bounds(Vec3d(center), Vec3d(double(p.w)));
        bounds_.extend(ball);
    }
    if (!(widest > 0.0f)) throw InputError("all radii of the curve are 0");
    // The mean over 2 x 8 points of each segment: bends cancel between opposite sides.
    double sum = 0.0;
    for (std::uint32_t s = 0; s < data_.segments.size(); ++s)
        for (int i = 0; i < 8; ++i) {
            const Point p = point_at(s, (i + 0.5) / 8.0);
            const Vec3d side = Cross(p.tangent()).start;
            sum += (p.area_element(side) + p.area_element(-side)) * std::numbers::pi / 8.0;
        }
    area_ = float(sum);
}

Curves::Point Curves::point_at(std::uint32_t segment, double u) const {
    const glm::vec4* p = &data_.points[data_.segments[segment]];
    glm::dvec4 value(0.0), slope(0.0), bend(0.0);
    if (data_.basis == CurveBasis::linear) {
        slope = glm::dvec4(p[1]) - glm::dvec4(p[0]);
        value = glm::dvec4(p[0]) + u * slope;
    } else {
        const Weights w = spline(u), w1 = spline_slope(u), w2 = spline_bend(u);
        for (std::size_t i = 0; i < 4; ++i) {
            const glm::dvec4 control(p[i]);
            value += w[i] * control, slope += w1[i] * control, bend += w2[i] * control;
        }
    }
    return {Vec3d(value), Vec3d(slope), Vec3d(bend), value.w, slope.w};
}

/// The parameter of the ball along a straight piece that touches its surface at p: (p - c) . c' = -r r'. What
/// Embree reports for thin ones is often that of the nearer joint.
double Curves::touching_ball(std::uint32_t segment, const Vec3d& p) const {
    const Point start = point_at(segment, 0.0);
    const double stretch = glm::dot(start.slope, start.slope) - start.radius_slope * start.radius_slope;
    if (!(stretch > 0.0))
        return start.radius_slope > 0.0 ? 1.0 : 0.0;  // one end lies within the other's ball
    const double v = (glm::dot(p - start.center, start.slope) + start.radius * start.radius_slope) / stretch;
    return std::fmin(1.0, std::fmax(0.0, v));
}

void Curves::fill_hit(std::uint32_t segment, float reported, const Vec3d& near, SurfaceHit& hit) const {
    const double along = data_.basis == CurveBasis::linear ? touching_ball(segment, near) : double(reported);
    const Point point = point_at(segment, along);
    Vec3d radial = near - point.center;
    // Round joints are met beside the plane across the line, the tube itself in it.
    if (data_.basis == CurveBasis::b_spline) radial -= point.tangent() * glm::dot(radial, point.tangent());
    const double length = glm::length(radial);
    fill(segment, along, point, length > 0.0 ? radial / length : Cross(point.tangent()).start, hit);
}

void Curves::fill(std::uint32_t segment, double along, const Point& point, const Vec3d& radial,
                  SurfaceHit& hit) const {
    // The gradient of |p - c(u)| - r(u), where (p - c(u)) . c'(u) = 0. Of a linear piece u is that of the
    // ball that touches the surface: its normal is radial.
    Vec3d n = radial;
    if (data_.basis == CurveBasis::b_spline) {
        const double stretch =
            glm::dot(point.slope, point.slope) - point.radius * glm::dot(radial, point.bend);
        const Vec3d gradient = stretch * radial - point.radius_slope * point.slope;
        if (const double length = glm::length(gradient); length > 0.0) n = gradient / length;
        if (glm::dot(n, radial) < 0.0) n = radial;  // within a bend sharper than the tube is thick
    }
    hit.position = Vec3(point.center + point.radius * radial);
    hit.geometric_normal = Vec3(n);
    const glm::vec4* p = &data_.points[data_.segments[segment]];
    const int last = data_.basis == CurveBasis::linear ? 1 : 3;
    const double extent = double(glm::length(Vec3(p[last]) - Vec3(p[0]))) + point.radius;
    hit.error = quantization_error(hit.position, hit.geometric_normal) + float(relative_error * extent);
    const Cross cross(point.tangent());
    if (tangent_matters) {  // u goes around, v along
        const double around = 2.0 * std::numbers::pi * point.radius;
        hit.dp_du = Vec3(around * glm::cross(point.tangent(), radial));
        hit.dp_dv = Vec3(double(data_.segments.size()) * point.slope);
        hit.shading = Frame(hit.geometric_normal, hit.dp_du);
    } else {
        hit.shading = Frame(hit.geometric_normal);
    }
    hit.uv = Vec2(turns(glm::dot(radial, cross.start), glm::dot(radial, cross.next)),
                  float((double(segment) + along) / double(data_.segments.size())));
    hit.shape = this;
    hit.primitive = segment;
}

ShapeSample Curves::sample_area(const Vec2& u) const {
    const double count = double(data_.segments.size()), position = double(u.x) * count;
    const auto segment = std::min(std::uint32_t(position), std::uint32_t(data_.segments.size() - 1));
    const double along = position - double(segment), angle = 2.0 * std::numbers::pi * double(u.y);
    const Point point = point_at(segment, along);
    const Cross cross(point.tangent());
    const Vec3d radial = std::cos(angle) * cross.start + std::sin(angle) * cross.next;
    SurfaceHit hit;
    fill(segment, along, point, radial, hit);
    const double density = 1.0 / (count * 2.0 * std::numbers::pi * std::fabs(point.area_element(radial)));
    return {hit.position, hit.geometric_normal, hit.uv, float(density), hit.error};
}

float Curves::pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const {
    const double count = double(data_.segments.size());
    const Point point = point_at(hit.primitive, double(hit.uv.y) * count - double(hit.primitive));
    const Vec3d radial = glm::normalize(Vec3d(hit.position) - point.center);
    const double density = 1.0 / (count * 2.0 * std::numbers::pi * std::fabs(point.area_element(radial)));
    const Vec3 to_light = hit.position - p;
    return area_to_solid_angle(float(density), glm::dot(to_light, to_light),
                               glm::dot(hit.geometric_normal, wi));
}

}  // namespace mote::core
