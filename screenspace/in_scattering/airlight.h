// Light of a point-like light that a homogeneous medium scatters once into a piece of a ray, nothing in the
// way: the air-light integral (Sun et al. 2005).
//
//   int exp(-sigma_t (t - t0 + d)) f_p / d^2 I dt,   d = |x(t) - light|
//
// With s the distance along the ray from the point nearest to the light, and h that point's distance from it,
// everything is written in y = asinh(s/h): dt/d = dy, and t + d grows as h e^y. All singularities of the
// integrand (of 1/d, and of Henyey-Greenstein's function for any g) then lie at Im y = +-pi/2, however close
// the light, and the exponential is bounded between them. So Gauss-Legendre rules on panels of a fixed length
// in y converge at one rate everywhere. The closed forms (Sun et al. 2005, F(u,v); Pegoraro & Parker 2009,
// by exponential integrals) are isotropic or power series in g, and subtract large numbers where pieces are
// short, far or dense; they serve as a test.
#pragma once

#include <functional>

#include "core/math/ray.h"

namespace mote::screenspace {

/// Geometry of a ray that passes a light. One that is on the ray is kept off it by what single precision
/// resolves.
struct PassingRay {
    double nearest;   ///< along the ray, of the point nearest to the light [m]
    double distance;  ///< of that point from the light: h [m]

    PassingRay(const core::Ray& ray, const core::Vec3& light);  ///< `light`: its position [m].
    /// From that point to t, as seen from the light [radians].
    double angle(double t) const { return std::atan2(t - nearest, distance); }
    /// Where angle() is `a` [m along the ray].
    double at_angle(double a) const { return nearest + distance * std::tan(a); }
};

/// The integral above for intensity 1 and Henyey-Greenstein scattering of mean cosine g (0: isotropic)
/// [1/(m sr)]. t1 may be infinite. Relative error below 1e-8 while sigma_t d stays below 700, where it
/// underflows.
double airlight(const PassingRay& ray, double t0, double t1, double sigma_t, double g);
/// For an intensity that varies smoothly along the piece; `intensity` is given distances along the ray.
double airlight(const PassingRay& ray, double t0, double t1, double sigma_t, double g,
                const std::function<double(double)>& intensity);

}  // namespace mote::screenspace
