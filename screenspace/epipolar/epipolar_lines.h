// The epipolar lines of a light: through its projection, evenly spread over the border of the picture.
//
// Eye rays through one such line lie in one plane with the light and meet the same rays of light, so what is
// scattered into them varies slowly along the line (Engelhardt 2013, Sec. 9.2.1). The light may be in front
// of the camera, behind it, or beside it, where its projection lies at infinity and the lines are parallel:
// homogeneous coordinates make one case of the three. A line ends where it leaves the picture, away from the
// light, and begins half a pixel off the light or where it enters the picture; border points that the lines
// enter by have no line of their own.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "screenspace/epipolar/epipolar_projection.h"

namespace mote::screenspace {

using core::Vec3d;
/// A place on the film [pixels].
using Vec2d = glm::dvec2;

/// A rectangle of the film [pixels].
struct FilmRectangle {
    Vec2d lower{0.0}, upper{1.0};                                    ///< corners
    double width() const { return upper.x - lower.x; }               ///< [pixels]
    double height() const { return upper.y - lower.y; }              ///< [pixels]
    double perimeter() const { return 2.0 * (width() + height()); }  ///< [pixels]
};

/// One line.
struct EpipolarLine {
    Vec2d start, end;  ///< start is the end nearer to the light's projection
    double length() const { return glm::length(end - start); }                    ///< [pixels]
    Vec2d at(double fraction) const { return start + fraction * (end - start); }  ///< between start and end
    /// Fraction of the line at the foot of the perpendicular from p, in [0, 1].
    double project(const Vec2d& p) const;
};

/// All lines of a light.
class EpipolarLines {
  public:
    /// `count` lines for the whole border, those that are not visible included, shifted by the fraction
    /// `offset` in [0, 1) of their distance. Where the projection lies outside, the corners that bound the
    /// visible part of the border get a line each, so that no point of the picture is outside all of them.
    /// Throws std::invalid_argument unless count > 0, the rectangle has an area and the point is not the
    /// eye's.
    EpipolarLines(const FilmPoint& light, const FilmRectangle& frame, int count, double offset);

    std::span<const EpipolarLine> lines() const { return lines_; }  ///< around the border
    /// The two lines that p lies between; both the same where there is no other.
    struct Pair {
        std::size_t before, after;  ///< indices of lines
    };
    /// Lines around a place on the film.
    Pair around(Vec2d p) const;
    /// The line next to i, one further in the direction of `step` (-1 or 1); nothing beyond the last.
    std::optional<std::size_t> next(std::size_t i, int step) const;
    bool light_inside() const { return inside_; }  ///< its projection is within the rectangle

  private:
    Vec2d away_from_light(const Vec2d& p) const;
    double exit(const Vec2d& p) const;
    Vec2d border_point(double s) const;
    EpipolarLine line_through(const Vec2d& end) const;
    void find_visible_border();

    FilmPoint light_;
    FilmRectangle frame_;
    bool inside_ = false;
    double first_ = 0.0, last_ = 0.0;  ///< the visible part of the border; last_ may go beyond the perimeter
    std::vector<EpipolarLine> lines_;
    std::vector<double> ends_;  ///< of the lines along the border, ascending
};

}  // namespace mote::screenspace
