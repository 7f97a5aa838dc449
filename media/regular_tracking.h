// Regular tracking: optical depths and free flights voxel by voxel, without a majorant.
//
// Woodcock's tracking samples as many tentative collisions as the majorant's optical depth says, however
// little is there: one voxel of 1e37 among 0.1, and the walk past it never ends, even against a bound of that
// voxel alone. Between voxel centres, though, the trilinear density along a ray is a cubic polynomial, so two
// lookups integrate it exactly (Gauss-Legendre), and a free flight is the root of a quartic (after Sutton et
// al. 1999, whose voxels are constant). That costs what the ray crosses, whatever the values; it pays in
// cells whose bounds are dense and far apart.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "core/math/vec.h"
#include "media/cell_walk.h"

namespace mote::media::detail {

/// A majorant above this optical depth a voxel [1], in a cell whose least value is below 1/16 of it: more
/// tentative collisions than regular tracking needs lookups.
inline constexpr double regular_depth_per_voxel = 16.0;
inline constexpr double regular_contrast = 16.0;

/// A ray in index space and the lattice of voxel centres that it crosses.
struct VoxelRay {
    core::Vec3d origin, direction;
    core::Vec3d corner;  ///< a voxel centre, and the numbers of voxels from there
    glm::ivec3 resolution;
};

/// Nodes of the quadrature with two points on [0, 1]; exact for cubic polynomials.
inline constexpr std::array gauss_nodes = {0.21132486540518711775, 0.78867513459481288225};

/// The integral of `lookup` along the ray over [from, to], which lie between the same voxel centres. [value *
/// t]
template <typename Lookup>
auto integral_within_voxel(const Lookup& lookup, const VoxelRay& ray, double from, double to) {
    const auto at = [&](double x) { return lookup(ray.origin + (from + x * (to - from)) * ray.direction); };
    return (at(gauss_nodes[0]) + at(gauss_nodes[1])) * (0.5 * (to - from));
}

/// Calls visit(from, to, integral) -> bool (false stops) for what [t0, t1] crosses between voxel centres, in
/// order.
template <typename Lookup, typename Visit>
void for_each_voxel(const Lookup& lookup, const VoxelRay& ray, double t0, double t1, Visit&& visit) {
    CellWalk walk(ray.origin - ray.corner, ray.direction, 1.0 / ray.direction, 1.0, ray.resolution);
    walk.go_to(t0);
    for (double t = t0;;) {
        const double crossing = walk.next_crossing(), end = std::fmin(crossing, t1);
        if (end > t) {
            if (!visit(t, end, integral_within_voxel(lookup, ray, t, end))) return;
            t = end;
        }
        if (!(crossing < t1)) return;
        walk.cross();
    }
}

/// Where the integral of a non-negative cubic polynomial over [0, x] reaches `fraction` of that over [0, 1];
/// `f` are its values at 0, 1/3, 2/3 and 1.
inline double inverse_integral(const std::array<double, 4>& f, double fraction) {
    // Differences of equidistant values give the polynomial in y = 3 x (Newton), its integral by powers of y.
    const double d1 = f[1] - f[0], d2 = f[2] - 2.0 * f[1] + f[0], d3 = f[3] - 3.0 * f[2] + 3.0 * f[1] - f[0];
    const double c1 = d1 - d2 / 2.0 + d3 / 3.0, c2 = d2 / 2.0 - d3 / 2.0, c3 = d3 / 6.0;
    const auto integral = [&](double y) {
        return y * (f[0] + y * (c1 / 2.0 + y * (c2 / 3.0 + y * (c3 / 4.0))));
    };
    const double wanted = fraction * integral(3.0);
    double low = 0.0, high = 3.0;
    for (int i = 0; i < 50; ++i) {  // it grows with y: bisection, to the last bits of a place on the ray
        const double middle = 0.5 * (low + high);
        (integral(middle) < wanted ? low : high) = middle;
    }
    return (low + high) / 6.0;
}

}  // namespace mote::media::detail
