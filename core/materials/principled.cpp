// BSDF "principled": metals, plastics, cloth and glass from one set of weights (Burley 2012 and 2015), as in
// Mitsuba 3.9, whose values and densities it has.
//
// Seen from above, the sum of a GGX lobe of facets that are metal, dielectric or both, of light refracted by
// the dielectric ones, of a diffuse base with sheen, and of a clearcoat. From below only dielectric facets
// are seen.
#include "core/materials/bsdfs.h"
#include "core/materials/dielectric_facet.h"
#include "core/materials/principled_terms.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/materials/textures.h"
#include "core/math/warp.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

class Principled final : public Bsdf {
  public:
    explicit Principled(const PrincipledParameters& p)
        : rates_(p.rates),
          eta_(p.eta),
          base_color_(p.base_color),
          roughness_(p.roughness),
          anisotropic_(p.anisotropic),
          metallic_(p.metallic),
          spec_trans_(p.spec_trans),
          spec_tint_(p.spec_tint),
          sheen_(p.sheen),
          sheen_tint_(p.sheen_tint),
          flatness_(p.flatness),
          clearcoat_(p.clearcoat),
          clearcoat_gloss_(p.clearcoat_gloss) {
        // Facets of index 1 refract nothing: the half vector of a straight path has no direction.
        if (eta_ == 1.0f && !spec_trans_.zero()) eta_ = 1.001f;
    }

    BsdfTraits traits() const override {
        bool textured = base_color_.textured();
        for (const ScalarSlot* s : {&roughness_, &anisotropic_, &metallic_, &spec_trans_, &spec_tint_,
                                    &sheen_, &sheen_tint_, &flatness_, &clearcoat_, &clearcoat_gloss_})
            textured = textured || s->textured();
        return {.smooth = true,
                .transmissive = !spec_trans_.zero(),
                .textured = textured,
                .anisotropic = !anisotropic_.zero()};
    }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
        const Weights w = weights(p);
        if (!seen(w, wo, wi)) return Rgb(0.0f);
        const DielectricFacet f = dielectric_facet(w.facets, eta_, wo, wi);
        const Rgb base = base_color_.eval(p.uv);
        // Walter 2007, Eqs. 20 and 21 with G / (cos cos) = 1 / area.
        const float area = w.facets.projected_area(wo) * w.facets.projected_area(wi);
        const auto lobe = [&](const Rgb& facet) {
            const Rgb weight = facet / area;
            const float peak = max_component(weight) * std::fabs(wi.z);
            return weight * (f.density > 0.0f || p.peak_limit < infinity
                                 ? w.facets.widened(peak, p.peak_limit).density(f.normal)
                                 : 0.0f);
        };
        if (f.transmitted) {
            const float scale = mode == TransportMode::radiance ? 1.0f / sqr(f.eta) : 1.0f;
            return lobe(glm::sqrt(base) * (w.glass * scale * (1.0f - f.reflectance) * f.jacobian * f.cos_o));
        }
        if (wo.z < 0.0f) return lobe(Rgb(w.glass * f.reflectance * 0.25f));
        Rgb value = lobe(reflectance(p, w, base, f.reflectance, f.cos_o) * 0.25f);
        if (w.clearcoat > 0.0f) value += Rgb(clearcoat(p, w, f, wo, wi));
        if (w.diffuse > 0.0f) {
            value += base * (w.diffuse * inv_pi *
                             principled_diffuse(wo.z, wi.z, f.cos_o, w.roughness, flatness_.eval(p.uv)));
            value += sheen(p, w, base) * schlick_weight(f.cos_o);
        }
        return value;
    }

    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        const Weights w = weights(p);
        if (!seen(w, wo, wi)) return 0.0f;
        const DielectricFacet f = dielectric_facet(w.facets, eta_, wo, wi);
        const Choice c = choice(w, wo);
        // Walter 2007, Eq. 38 with the Jacobians of Eqs. 14 and 17, for visible normals.
        const float lobe = c.specular * f.density / w.facets.projected_area(wo);
        const float refracted = c.glass * (1.0f - f.reflectance);
        if (f.transmitted) return refracted * lobe * f.jacobian * f.cos_o;
        float pdf = (1.0f - refracted) * lobe * 0.25f + c.diffuse * cosine_hemisphere_pdf(wi);
        if (c.clearcoat > 0.0f)
            pdf += c.clearcoat * coat(p).density(f.normal) * f.normal.z / (4.0f * f.cos_o);
        return pdf;
    }

    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        const Weights w = weights(p);
        if (wo.z == 0.0f || (wo.z < 0.0f && w.glass == 0.0f)) return std::nullopt;
        const Choice c = choice(w, wo);
        BsdfSample s{.wi = -wo, .weight = Rgb(0.0f), .pdf_solid_angle = 0.0f};
        if (u_lobe < c.diffuse) {
            s.wi = square_to_cosine_hemisphere(u);
        } else if (u_lobe < c.diffuse + c.clearcoat) {
            const Vec3 m = coat(p).sample(u);
            s.wi = 2.0f * glm::dot(wo, m) * m - wo;
        } else if (c.specular > 0.0f) {
            sample_facet(w, c, wo, (u_lobe - c.diffuse - c.clearcoat) / c.specular, u, s);
        }
        if (!s.transmitted && !(s.wi.z * wo.z > 0.0f))
            return std::nullopt;  // would meet the surface again: lost
        s.pdf_solid_angle = pdf_solid_angle(p, wo, s.wi, mode);
        if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
        s.weight = eval(p, wo, s.wi, mode) * (std::fabs(s.wi.z) / s.pdf_solid_angle);
        if (is_black(s.weight)) return std::nullopt;
        return s;
    }

    /// Albedo of power, with smooth facets; the retro-reflection of rough bases at grazing angles is left
    /// out.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const Weights w = weights(p);
        const float cosine = std::fmin(std::fabs(wo.z), 1.0f);
        const Rgb base = base_color_.eval(p.uv), glass = w.glass * glm::sqrt(base);
        const float f = fresnel_dielectric(cosine, wo.z > 0.0f ? eta_ : 1.0f / eta_).reflectance;
        if (!(wo.z > 0.0f)) return w.glass * f + (1.0f - f) * glass;
        const Rgb coat(w.clearcoat * 0.04f * sqr(cosine));
        const Rgb cloth = w.diffuse > 0.0f ? sheen(p, w, base) * (0.088f * sqr(1.0f - cosine)) : Rgb(0.0f);
        return glm::min(
            reflectance(p, w, base, f, cosine) + (1.0f - f) * glass + w.diffuse * base + coat + cloth,
            Rgb(1.0f));
    }

  private:
    struct Weights {
        float roughness, metallic, clearcoat;
        float diffuse, glass;  ///< of the opaque and of the transparent dielectric
        Microfacet facets;
    };
    /// Probabilities of the lobes. `glass` is the fraction of the facets that light is refracted through,
    /// which takes that fraction of (1 - F) from the reflection.
    struct Choice {
        float diffuse, clearcoat, specular, glass;
    };

    Weights weights(const BsdfPoint& p) const {
        const float roughness = roughness_.eval(p.uv), metallic = metallic_.eval(p.uv),
                    spec_trans = spec_trans_.eval(p.uv);
        return {roughness,
                metallic,
                clearcoat_.eval(p.uv),
                (1.0f - metallic) * (1.0f - spec_trans),
                (1.0f - metallic) * spec_trans,
                principled_facets(roughness, anisotropic_.eval(p.uv))};
    }
    /// Directions that light goes between at all. Only glass is seen from below, or through.
    static bool seen(const Weights& w, const Vec3& wo, const Vec3& wi) {
        return wo.z != 0.0f && wi.z != 0.0f && (w.glass > 0.0f || (wo.z > 0.0f && wi.z > 0.0f));
    }
    Choice choice(const Weights& w, const Vec3& wo) const {
        if (wo.z < 0.0f) return {0.0f, 0.0f, 1.0f, 1.0f};
        const float d = w.diffuse * rates_.diffuse, c = 0.25f * w.clearcoat * rates_.clearcoat;
        const float sum = d + c + rates_.specular;
        if (!(sum > 0.0f)) return {0.0f, 0.0f, 0.0f, 0.0f};
        return {d / sum, c / sum, rates_.specular / sum, w.glass};
    }
    void sample_facet(const Weights& w, const Choice& c, const Vec3& wo, float u_side, const Vec2& u,
                      BsdfSample& s) const {
        const float side = wo.z > 0.0f ? 1.0f : -1.0f, eta = side > 0.0f ? eta_ : 1.0f / eta_;
        const Vec3 m = side * w.facets.sample_visible(side * wo, u);  // on wo's side
        const float cos_o = std::fmin(glm::dot(wo, m), 1.0f);
        if (!(cos_o > 0.0f)) return;
        const auto fresnel = fresnel_dielectric(cos_o, eta);
        if (u_side >= c.glass * (1.0f - fresnel.reflectance)) {
            s.wi = 2.0f * cos_o * m - wo;
            return;
        }
        const Vec3 wi = glm::normalize(refract(wo, m, cos_o, fresnel.cos_t, eta));
        s.transmitted = wi.z * wo.z < 0.0f;  // else masked
        if (s.transmitted) s.wi = wi, s.eta = eta;
    }

    /// Reflectance of the facets, seen from above at cos_d: `dielectric` is their exact Fresnel reflectance,
    /// blended with Schlick's for metal and for tinted reflection. As in Mitsuba, facets of index 1 reflect
    /// nothing, metal or not.
    Rgb reflectance(const BsdfPoint& p, const Weights& w, const Rgb& base, float dielectric,
                    float cos_d) const {
        if (!(dielectric > 0.0f)) return Rgb(0.0f);
        const float tint = spec_tint_.eval(p.uv);
        Rgb f((1.0f - w.metallic) * (1.0f - tint) * dielectric);
        if (w.metallic > 0.0f) f += w.metallic * schlick_reflectance(base, cos_d, eta_);
        if (tint > 0.0f)
            f += (1.0f - w.metallic) * tint *
                 schlick_reflectance(tint_of(base) * normal_reflectance(eta_), cos_d, eta_);
        return f;
    }
    ClearcoatNormals coat(const BsdfPoint& p) const { return ClearcoatNormals(clearcoat_gloss_.eval(p.uv)); }
    /// Burley 2012, Sec. 5.4: index 1.5, masked as if its roughness were 0.25, a quarter of the strength.
    float clearcoat(const BsdfPoint& p, const Weights& w, const DielectricFacet& f, const Vec3& wo,
                    const Vec3& wi) const {
        const float fresnel = lerp(0.04f, 1.0f, schlick_weight(f.cos_o, eta_));
        const Microfacet mask(MicrofacetKind::ggx, 0.25f);
        return 0.25f * w.clearcoat * fresnel * coat(p).density(f.normal) * mask.masking(wo) *
               mask.masking(wi);
    }
    Rgb sheen(const BsdfPoint& p, const Weights& w, const Rgb& base) const {
        return sheen_colour(base, sheen_.eval(p.uv) * (1.0f - w.metallic), sheen_tint_.eval(p.uv));
    }

    PrincipledParameters::Rates rates_;
    float eta_;  ///< below the surface over above
    TextureSlot base_color_;
    ScalarSlot roughness_, anisotropic_, metallic_, spec_trans_, spec_tint_, sheen_, sheen_tint_, flatness_,
        clearcoat_, clearcoat_gloss_;
};

}  // namespace

std::shared_ptr<Bsdf> make_principled(const PrincipledParameters& parameters) {
    return std::make_shared<Principled>(parameters);
}

}  // namespace mote::core
