// The terms that "principled" and "principledthin" are sums of: Burley 2012 (diffuse, sheen, clearcoat),
// Burley 2015 (transmission, flatness, tints), with the constants of Mitsuba 3.9. Cosines lie in [0, 1].
#pragma once

#include <algorithm>

#include "core/materials/fresnel.h"
#include "core/materials/microfacet.h"

namespace mote::core {

/// Schlick's (1 - cos)^5.
inline float schlick_weight(float cosine) {
    const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f);
    return sqr(sqr(m)) * m;
}

/// Schlick's weight on the side of the smaller index: 1 where all light is reflected. `eta` is the far side
/// over the near side.
inline float schlick_weight(float cosine, float eta) {
    if (eta > 1.0f) return schlick_weight(cosine);
    return schlick_weight(safe_sqrt(1.0f - (1.0f - sqr(cosine)) / sqr(eta)));
}

/// Schlick's approximation: r0 head on, 1 at grazing angles.
inline Rgb schlick_reflectance(const Rgb& r0, float cosine, float eta) {
    return glm::mix(r0, Rgb(1.0f), schlick_weight(cosine, eta));
}

/// Exact reflectance head on.
inline float normal_reflectance(float eta) { return sqr((eta - 1.0f) / (eta + 1.0f)); }

/// A colour of luminance 1; white for black.
inline Rgb tint_of(const Rgb& base) {
    const float l = luminance(base);
    return l > 0.0f ? base / l : Rgb(1.0f);
}

/// GGX with alpha = roughness^2, stretched by the square root of 1 - 0.9 anisotropic (Burley 2012, Sec. 5.4).
inline Microfacet principled_facets(float roughness, float anisotropic) {
    const float alpha = sqr(roughness), aspect = std::sqrt(1.0f - 0.9f * anisotropic);
    constexpr float smallest = 0.001f;
    return {MicrofacetKind::ggx, std::fmax(smallest, alpha / aspect), std::fmax(smallest, alpha * aspect)};
}

/// The diffuse lobe times pi, for a white base: Burley 2015, Sec. 4 with the retro-reflection of Eq. 4,
/// blended by `flatness` with the approximation of subsurface scattering of Burley 2012, Sec. 5.3 (Hanrahan &
/// Krueger 1993). `cos_d` is that between either direction and their half vector.
inline float principled_diffuse(float cos_o, float cos_i, float cos_d, float roughness, float flatness) {
    const float fo = schlick_weight(cos_o), fi = schlick_weight(cos_i), rr = 2.0f * roughness * sqr(cos_d);
    const float lambert = (1.0f - 0.5f * fo) * (1.0f - 0.5f * fi),
                retro = rr * (fo + fi + fo * fi * (rr - 1.0f));
    if (flatness == 0.0f) return lambert + retro;
    const float ss = lerp(1.0f, 0.5f * rr, fo) * lerp(1.0f, 0.5f * rr, fi);
    const float flat = 1.25f * (ss * (1.0f / std::fmax(cos_o + cos_i, 1e-30f) - 0.5f) + 0.5f);
    return lerp(lambert + retro, flat, flatness);
}

/// The colour of the sheen, whose lobe is Schlick's weight of cos_d (Burley 2012, Sec. 5.3). Mitsuba does not
/// divide it by pi.
inline Rgb sheen_colour(const Rgb& base, float sheen, float sheen_tint) {
    return sheen * glm::mix(Rgb(1.0f), tint_of(base), sheen_tint);
}

/// Normals of the clearcoat: generalised Trowbridge-Reitz with exponent 1 (Burley 2012, Eq. 4 of App. B).
class ClearcoatNormals {
  public:
    explicit ClearcoatNormals(float gloss) : alpha2_(sqr(lerp(0.1f, 0.001f, gloss))) {}

    /// D(m) [1/sr] for m.z > 0. Normalised: D cos integrates to 1.
    float density(const Vec3& m) const {
        const float sin2 = sqr(m.x) + sqr(m.y);
        return (alpha2_ - 1.0f) * inv_pi / (std::log(alpha2_) * (sin2 + alpha2_ * sqr(m.z)));
    }
    /// A normal m with the density D(m) cos(m).
    Vec3 sample(const Vec2& u) const {
        const float cos2 = (1.0f - std::pow(alpha2_, 1.0f - u.x)) / (1.0f - alpha2_);
        const float r = safe_sqrt(1.0f - cos2), phi = 2.0f * pi * u.y;
        return {r * std::cos(phi), r * std::sin(phi), safe_sqrt(cos2)};
    }

  private:
    float alpha2_;
};

}  // namespace mote::core
