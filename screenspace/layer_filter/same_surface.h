// Similarity of two pixels: a weight in [0, 1] from geometry alone, (1 - x^2)^2 of each difference x in units
// of its tolerance, and exactly zero from there on, so that nothing leaks.
#pragma once

#include "core/math/vec.h"
#include "core/math/vectorize.h"

namespace mote::screenspace {

/// Distance of one pixel's point to the tangent plane of the other, in footprints of a pixel: within it, two
/// points could as well lie on one surface.
inline constexpr float surface_tolerance = 2.0f;
/// 1 - cosine of the angle between shading normals: 30 degrees.
inline constexpr float normal_tolerance = 0.134f;
/// Fraction of the light scattered towards the eye that comes from between the surfaces of two pixels.
inline constexpr float depth_tolerance = 0.1f;

inline float tukey(float x_squared) {
    const float rest = core::max_of(0.0f, 1.0f - x_squared);
    return rest * rest;
}

/// `off_plane` [m]: the farther of both points from the other's plane.
inline float same_surface(float off_plane, float footprint, float cosine) {
    const float tolerance = surface_tolerance * footprint;
    const float plane = tukey(off_plane * off_plane / core::max_of(tolerance * tolerance, 1e-37f));
    const float bend = core::max_of(0.0f, 1.0f - cosine) * (1.0f / normal_tolerance);
    return plane * tukey(bend * bend);
}

/// Fraction of the light that a medium scatters into two neighbouring rays between their ends: with the
/// mean extinction s up to the nearer end at t, T the transmittance there and d the distance between both,
///   T (1 - exp(-s d)) / (1 - T exp(-s d)),   1 - exp(-x) taken as x / (1 + x).
/// `log_transmittance` is ln T of the nearer one. Slanted walls have no step: d is their distance from the
/// other's plane.
inline float between_depths(float step, float near, float transmittance, float log_transmittance) {
    const float x = -log_transmittance * step / core::max_of(near, 1e-30f);
    const float lost = x / (1.0f + x);
    const float rest = core::max_of(1.0f - transmittance * (1.0f - lost), 1e-6f);
    return transmittance * lost / rest;
}

}  // namespace mote::screenspace
