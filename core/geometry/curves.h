// Thin round tubes along curves: hair, grass, wire.
//
// Embree finds where a ray meets them. Like Mitsuba's they are seen from outside only: a ray that starts
// within a tube, or has entered it, does not meet it from inside, so a tube bounds no medium and refracts
// nothing rightly.
#pragma once

#include <span>

#include "core/geometry/shape.h"

namespace mote::core {

enum class CurveBasis {
    linear,   ///< straight pieces with round joints and round ends
    b_spline  ///< uniform cubic B-splines, cut off across at the ends
};

struct CurveData {
    CurveBasis basis = CurveBasis::b_spline;
    std::vector<glm::vec4> points;        ///< control points in the world and radii [m]
    std::vector<std::uint32_t> segments;  ///< the first of the 2 (linear) or 4 control points of each
};

class Curves final : public Shape {
  public:
    /// Throws InputError when there is no segment, an index is out of range, a point is not finite or beyond
    /// 1e18, or a radius is negative.
    explicit Curves(CurveData data);

    const CurveData& data() const { return data_; }
    /// Fills everything of a hit but t. `along`: the parameter within the segment that Embree reports, in
    /// [0, 1]; `near`: the point on the ray, which is moved onto the surface.
    void fill_hit(std::uint32_t segment, float along, const Vec3d& near, SurfaceHit& hit) const;

    Bounds3 bounds() const override { return bounds_; }
    /// Area of the tubes without their round joints and ends; what overlaps at bends is counted.
    float area() const override { return area_; }
    /// Even along the parameter of each segment and around it; pdf_area says where that is dense.
    ShapeSample sample_area(const Vec2& u) const override;
    float pdf_visible(const Vec3& p, const Vec3& wi, const SurfaceHit& hit) const override;
    bool closed() const override { return false; }
    std::size_t primitive_count() const override { return data_.segments.size(); }

  private:
    struct Point;  ///< of the centre line
    Point point_at(std::uint32_t segment, double along) const;
    double touching_ball(std::uint32_t segment, const Vec3d& p) const;
    void fill(std::uint32_t segment, double along, const Point& point, const Vec3d& radial,
              SurfaceHit& hit) const;

    CurveData data_;
    Bounds3 bounds_;
    float area_ = 0.0f;
};

}  // namespace mote::core
