// Distances on lines: in proportion to one over the distance from another line, or over the squared distance
// from a point.
//
// Virtual ray lights need the integral of 1/w^2 over two lines, w the distance of a point of one from a
// point of the other. Novak et al. 2012, Sec. 4: with h the smallest distance of the lines and theta their
// angle,
//   w^2 = h^2 + u^2 + v^2 - 2 u v cos(theta)
// where u and v are counted from the points that are nearest to each other. The integral over all v is
// pi / sqrt(h^2 + u^2 sin^2 theta), so u is sampled in proportion to that,
//   p(u) ~ 1/sqrt(h^2 + u^2 sin^2 theta),  whose integral is asinh(u sin(theta) / h) / sin(theta),
// and v then equi-angularly around the point at u (Kulla and Fajardo 2012). What is left of the integrand is
// bounded: (theta_b - theta_a) times the difference of the asinh over sin(theta).
//
// Both densities may be multiplied by a function that is constant on cells of the line.
#pragma once

#include <optional>
#include <span>

#include "core/math/vec.h"

namespace mote::lights {

/// Nearest points of two lines. Distances in metres along each, from its origin.
struct LinePair {
    double nearest_first = 0.0, nearest_second = 0.0;  ///< of the points that are nearest to each other
    double distance = 0.0;                             ///< h: of these two points
    double sine = 0.0;  ///< of the angle of the lines, 0 where they are parallel
};

/// Relative position of two lines with unit directions. Of parallel lines all points are nearest: that of the
/// second is its origin.
LinePair line_pair(const core::Vec3d& first_origin, const core::Vec3d& first_direction,
                   const core::Vec3d& second_origin, const core::Vec3d& second_direction);

/// The density 1 / sqrt(h^2 + s^2 (u - u_0)^2), not normalised.
struct InverseDistance {
    double nearest;   ///< u_0
    double distance;  ///< h, above 0
    double sine;      ///< s
    double density(double u) const;
    /// From u_0 to u: asinh(s (u - u_0) / h) / s; (u - u_0) / h where s is 0.
    double integral(double u) const;
    double inverse(double integral) const;  ///< the u of an integral
};

/// The density 1 / (D^2 + (v - v_0)^2), not normalised.
struct InverseSquare {
    double nearest;   ///< v_0
    double distance;  ///< D, above 0
    double density(double v) const;
    double integral(double v) const;        ///< from v_0 to v: atan((v - v_0) / D) / D
    double inverse(double integral) const;  ///< the v of an integral
};

/// A distance on a line.
struct LineSample {
    double position;      ///< [m]
    double pdf_distance;  ///< [1/m]
};

/// At most so many cells on a line.
inline constexpr std::size_t max_cells = 16;

/// Samples the range [begin, end] of a line of `length`, in proportion to the density times the weight of
/// the cell; weights are those of equal parts of the whole line, at most max_cells, not negative. Nothing
/// where there is nothing to sample from.
template <typename Density>
std::optional<LineSample> sample_line(const Density& density, double begin, double end, double length,
                                      std::span<const float> weights, float u);

extern template std::optional<LineSample> sample_line(const InverseDistance&, double, double, double,
                                                      std::span<const float>, float);
extern template std::optional<LineSample> sample_line(const InverseSquare&, double, double, double,
                                                      std::span<const float>, float);

}  // namespace mote::lights
