// Reflectance and transmittance of a rough dielectric boundary, tabulated once per material.
#pragma once

#include <array>
#include <cstdint>

#include "core/materials/microfacet.h"

namespace mote::core {

/// Fate of the light that meets a second facet, which single scattering does not follow.
enum class LostLight : std::uint8_t {
    absorbed,     ///< it is gone (Mitsuba)
    transmitted,  ///< it passes the boundary
};

/// Fraction of the power arriving at angle acos(mu) that leaves by a single reflection at a rough boundary of
/// relative index eta (far side over near side): the integral of F(wo.m) G1(wi) over the visible normals.
double rough_reflectance(const Microfacet& microfacet, float eta, float mu);
/// Transmittance of a single refraction: the integral of (1 - F(wo.m)) G1(wt).
double rough_transmittance(const Microfacet& microfacet, float eta, float mu);

/// rough_transmittance(), or 1 - rough_reflectance(), against mu, interpolated linearly.
class RoughTransmittance {
  public:
    RoughTransmittance(const Microfacet& microfacet, float eta, LostLight lost);
    float operator()(float mu) const {
        const float x = std::fmin(std::fmax(mu, 0.0f), 1.0f) * float(size - 1);
        const auto i = std::size_t(std::fmin(x, float(size - 2)));
        return lerp(table_[i], table_[i + 1], x - float(i));
    }
    /// The integral of T(mu) 2 mu over [0, 1]: under uniform illumination. Exact for the interpolant.
    float mean() const { return mean_; }

  private:
    static constexpr std::size_t size = 64;
    void lower_the_first(const Microfacet& microfacet, float eta);

    std::array<float, size> table_{};
    float mean_ = 0.0f;
};

/// Mean reflectance of the boundary seen from inside, under uniform illumination, for single scattering: the
/// mean of 2 mu R(mu) over 64 equidistant mu from 0 to 1, both ends included. That sum is Mitsuba's, some 2 %
/// below the integral, which makes a base 2 % darker.
float rough_internal_reflectance(const Microfacet& microfacet, float eta);

}  // namespace mote::core
