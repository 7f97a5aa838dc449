// Relative energy loss by a bound in a medium, and what of it is left after k steps of compensation.
//
// Where the light in a medium is about the same at y and at z, one application of the residual transport
// (Engelhardt 2013, Eq. 10.11) to it is a factor,
//   beta = integral over t from 0 to r of  sigma_s e^(-sigma_t t) (1 - b t^2) dt,   r = b^(-1/2),
// because directions integrate to one for every phase function. Without a bound the same integral runs over
// the whole medium, on average along its mean chord D:  beta_all = albedo (1 - e^(-sigma_t D)).  Of the light
// that reaches a point of the medium from the medium, bounded VPLs leave out beta / beta_all, and what k
// steps leave out is beta^(k+1) / beta_all. Walls that send light to the point make the fraction smaller.
// This is no bound but an estimate; the study experiments/studies/vpls_and_media.py measures how well it
// holds.
#pragma once

#include <cmath>

namespace mote::compensation {

/// beta for extinction [1/m], scattering coefficient [1/m] and bound [1/m^2], all >= 0; below 1.
inline double residual_fraction(double sigma_t, double sigma_s, double bound) {
    if (!(sigma_t > 0.0) || !(sigma_s > 0.0) || !std::isfinite(bound)) return 0.0;
    const double albedo = sigma_s / sigma_t;
    if (!(bound > 0.0)) return albedo;
    const double d = sigma_t / std::sqrt(bound);  // optical depth of the radius
    if (d > 0.5) return albedo * (-std::expm1(-d) - (2.0 - std::exp(-d) * (d * d + 2.0 * d + 2.0)) / (d * d));
    // Power series: nothing cancels as d -> 0, where beta -> 2/3 sigma_s r.
    double sum = 0.0, power = d;  // (-1)^n d^(n+1) / n!
    for (int n = 0; n < 12; ++n) {
        sum += power * 2.0 / ((n + 1.0) * (n + 3.0));
        power *= -d / (n + 1.0);
    }
    return albedo * sum;
}

/// A homogeneous medium [1/m], and how far light goes in it: its mean chord [m], 4 V / S for a convex body.
struct ExpectedMedium {
    double sigma_t = 0.0, sigma_s = 0.0, chord = 0.0;

    double beta(double bound) const { return residual_fraction(sigma_t, sigma_s, bound); }
    double beta_all() const {
        return sigma_t > 0.0 ? -std::expm1(-sigma_t * chord) * sigma_s / sigma_t : 0.0;
    }
};

/// Relative loss that remains after `steps` steps (-1: no limit), 0 to 1.
double expected_loss(const ExpectedMedium& medium, double bound, int steps);

/// The bound [1/m^2] with which `steps` steps leave out `loss` of the light; 0 where any bound will do.
double bound_for_loss(const ExpectedMedium& medium, int steps, double loss);

}  // namespace mote::compensation
