// Distributions of microfacet normals: Beckmann and GGX (Trowbridge-Reitz), possibly anisotropic, with
// Smith's masking function and sampling of the visible normals.
//
// Everything rests on the projected area A(w) of the microsurface seen from w, cos(w) (1 + Lambda(w)) (Heitz
// 2014). Smith's G1 is cos(w) / A(w), and a reflection BRDF is F D / (4 A(wo) A(wi)): forms that stay finite
// at grazing angles, where cos(w) in a denominator would not.
#pragma once

#include <cstdint>

#include "core/math/frame.h"

namespace mote::core {

enum class MicrofacetKind : std::uint8_t { beckmann, ggx };

class Microfacet {
  public:
    /// Smallest roughness that single precision directions can carry; smaller ones are raised to it.
    static constexpr float smallest_alpha = 1e-4f;

    Microfacet(MicrofacetKind kind, float alpha_u, float alpha_v)
        : kind_(kind),
          alpha_u_(std::fmax(alpha_u, smallest_alpha)),
          alpha_v_(std::fmax(alpha_v, smallest_alpha)) {}
    Microfacet(MicrofacetKind kind, float alpha) : Microfacet(kind, alpha, alpha) {}

    MicrofacetKind kind() const { return kind_; }
    float alpha_u() const { return alpha_u_; }
    float alpha_v() const { return alpha_v_; }

    /// D(m) [1/sr]: area of facets with normal m per unit area of the surface and solid angle. Walter 2007,
    /// Eqs. 25 and 33. Zero for m.z <= 0.
    float density(const Vec3& m) const {
        if (!(m.z > 0.0f)) return 0.0f;
        const float slope2 = sqr(m.x / alpha_u_) + sqr(m.y / alpha_v_), cos2 = sqr(m.z);
        const float scale = inv_pi / (alpha_u_ * alpha_v_);
        if (kind_ == MicrofacetKind::ggx) return scale / sqr(cos2 + slope2);
        const float exponent = slope2 / cos2;
        return exponent < 80.0f ? scale * std::exp(-exponent) / sqr(cos2) : 0.0f;  // e^-80: zero in float
    }

    /// These facets, rougher where `weight` times the peak of D would be above `limit` [1/sr]. With
    /// D(0) = 1 / (pi alpha_u alpha_v), both alphas are at least sqrt(weight / (pi limit)) (Tokuyoshi & Ogaki
    /// 2012, Eqs. 9 and 12 with this D), and at most 1 for it: facets that point anywhere.
    Microfacet widened(float weight, float limit) const {
        if (!(limit < infinity)) return *this;
        const float least = std::fmin(1.0f, std::sqrt(weight * inv_pi / limit));
        return {kind_, std::fmax(alpha_u_, least), std::fmax(alpha_v_, least)};
    }

    /// |cos(w)| (1 + Lambda(w)), seen from either side. Positive wherever w.z != 0.
    float projected_area(const Vec3& w) const {
        const float c = std::fabs(w.z);
        const float spread2 = sqr(alpha_u_ * w.x) + sqr(alpha_v_ * w.y);
        if (kind_ == MicrofacetKind::ggx) return 0.5f * (c + std::sqrt(c * c + spread2));
        const float spread = std::sqrt(spread2);
        if (c >= 4.0f * spread) return c;  // Lambda < 1e-9
        const float a = c / spread;
        constexpr float inv_two_sqrt_pi = 0.28209479177387814f;
        return c * (1.0f - 0.5f * std::erfc(a)) + spread * inv_two_sqrt_pi * std::exp(-a * a);
    }

    /// Smith's masking G1(w), without the test for facets seen from behind.
    float masking(const Vec3& w) const { return std::fabs(w.z) / projected_area(w); }

    /// A normal m with the density pdf_visible(wo, m). Precondition: wo.z > 0.
    Vec3 sample_visible(const Vec3& wo, const Vec2& u) const;
    /// <wo, m> D(m) / A(wo) [1/sr]: the fraction of m in what is seen from wo (wo.z > 0).
    float pdf_visible(const Vec3& wo, const Vec3& m) const {
        const float c = glm::dot(wo, m);
        return c > 0.0f ? c * density(m) / projected_area(wo) : 0.0f;
    }

  private:
    MicrofacetKind kind_;
    float alpha_u_, alpha_v_;
};

/// normalize(a + b) through double precision: exact for nearly equal and for opposite grazing directions.
inline Vec3 half_vector(const Vec3& a, const Vec3& b) {
    const Vec3d h = Vec3d(a) + Vec3d(b);
    return Vec3(h * (1.0 / glm::length(h)));
}

}  // namespace mote::core
