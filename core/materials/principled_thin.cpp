// BSDF "principledthin": a sheet without thickness that reflects and lets through, glossy and diffuse (Burley
// 2015, Sec. 5.3), as in Mitsuba 3.9, whose values and densities it has.
//
// Seen from either side it is the same, turned round by half a turn. Light that passes the glossy part leaves
// in the reflected direction, mirrored at the sheet: nothing is refracted.
#include "core/materials/bsdfs.h"
#include "core/materials/principled_terms.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/materials/textures.h"
#include "core/math/warp.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

/// wo and wi as seen by someone on wo's side.
struct ThinPair {
    ThinPair(const Vec3& o, const Vec3& i)
        : wo(o.z > 0.0f ? o : -o), wi(o.z > 0.0f ? i : -i), mirrored(wi.x, wi.y, std::fabs(wi.z)) {
        const Vec3d sum = Vec3d(wo) + Vec3d(mirrored);
        const double length = glm::length(sum);
        half = Vec3(sum / length);
        cos_d = float(std::fmin(0.5 * length, 1.0));
        transmitted = wi.z < 0.0f;
    }
    Vec3 wo, wi;
    Vec3 mirrored;  ///< wi on wo's side
    Vec3 half;      ///< the facet's normal
    float cos_d;    ///< between either and the facet
    bool transmitted;
};

class PrincipledThin final : public Bsdf {
  public:
    explicit PrincipledThin(const PrincipledThinParameters& p)
        : rates_(p.rates),
          base_color_(p.base_color),
          roughness_(p.roughness),
          anisotropic_(p.anisotropic),
          spec_trans_(p.spec_trans),
          eta_(p.eta),
          spec_tint_(p.spec_tint),
          sheen_(p.sheen),
          sheen_tint_(p.sheen_tint),
          flatness_(p.flatness),
          diff_trans_(p.diff_trans) {}

    BsdfTraits traits() const override {
        bool textured = base_color_.textured();
        for (const ScalarSlot* s : {&roughness_, &anisotropic_, &spec_trans_, &eta_, &spec_tint_, &sheen_,
                                    &sheen_tint_, &flatness_, &diff_trans_})
            textured = textured || s->textured();
        return {.smooth = true,
                .transmissive = !spec_trans_.zero() || !diff_trans_.zero(),
                .textured = textured,
                .anisotropic = !anisotropic_.zero()};
    }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
        if (wo.z == 0.0f || wi.z == 0.0f) return Rgb(0.0f);
        const ThinPair d(wo, wi);
        const Rgb base = base_color_.eval(p.uv);
        const float glossy = spec_trans_.eval(p.uv), through = 0.5f * diff_trans_.eval(p.uv);
        Rgb value(0.0f);
        if (glossy > 0.0f && facet_seen(d, mode)) {
            const Microfacet facets = facets_at(p, d.transmitted);
            const Rgb weight =
                (d.transmitted ? base * (1.0f - fresnel(p, d.cos_d)) : reflectance(p, base, d.cos_d)) *
                (glossy / (4.0f * facets.projected_area(d.wo) * facets.projected_area(d.mirrored)));
            value =
                weight * facets.widened(max_component(weight) * d.mirrored.z, p.peak_limit).density(d.half);
        }
        if (d.transmitted) return value + base * ((1.0f - glossy) * through * inv_pi);
        const float diffuse =
            principled_diffuse(d.wo.z, d.wi.z, d.cos_d, roughness_.eval(p.uv), flatness_.eval(p.uv));
        const Rgb cloth = sheen_colour(base, sheen_.eval(p.uv), sheen_tint_.eval(p.uv));
        return value + (1.0f - glossy) * (1.0f - through) *
                           (base * (inv_pi * diffuse) + cloth * schlick_weight(d.cos_d));
    }

    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                          TransportMode mode) const override {
        if (wo.z == 0.0f || wi.z == 0.0f) return 0.0f;
        const ThinPair d(wo, wi);
        const Choice c = choice(p);
        float pdf = (d.transmitted ? c.diffuse_through : c.diffuse) * cosine_hemisphere_pdf(d.mirrored);
        const float glossy = d.transmitted ? c.glossy_through : c.glossy;
        if (glossy > 0.0f && facet_seen(d, mode)) {
            const Microfacet facets = facets_at(p, d.transmitted);
            pdf += glossy * facets.density(d.half) / (4.0f * facets.projected_area(d.wo));
        }
        return pdf;
    }

    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (wo.z == 0.0f) return std::nullopt;
        const Choice c = choice(p);
        const Vec3 seen = wo.z > 0.0f ? wo : -wo;
        const float to_diffuse = c.glossy + c.glossy_through;
        BsdfSample s{.wi = seen, .weight = Rgb(0.0f), .pdf_solid_angle = 0.0f};
        if (u_lobe < to_diffuse) {
            s.transmitted = u_lobe >= c.glossy;
            const Vec3 m = facets_at(p, s.transmitted).sample_visible(seen, u);
            s.wi = 2.0f * glm::dot(seen, m) * m - seen;
        } else {
            s.transmitted = u_lobe >= to_diffuse + c.diffuse;
            s.wi = square_to_cosine_hemisphere(u);
        }
        if (!(s.wi.z > 0.0f)) return std::nullopt;  // would meet the surface again: lost
        if (s.transmitted) s.wi.z = -s.wi.z;
        if (wo.z < 0.0f) s.wi = -s.wi;
        if (u_lobe < to_diffuse && !facet_seen(ThinPair(wo, s.wi), mode)) return std::nullopt;  // lost
        s.pdf_solid_angle = pdf_solid_angle(p, wo, s.wi, mode);
        if (!(s.pdf_solid_angle > 0.0f)) return std::nullopt;
        s.weight = eval(p, wo, s.wi, mode) * (std::fabs(s.wi.z) / s.pdf_solid_angle);
        if (is_black(s.weight)) return std::nullopt;
        return s;
    }

    /// With smooth facets; the retro-reflection of rough bases at grazing angles is left out.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const float cosine = std::fmin(std::fabs(wo.z), 1.0f), glossy = spec_trans_.eval(p.uv);
        const Rgb base = base_color_.eval(p.uv);
        const Rgb facets = reflectance(p, base, cosine) + (1.0f - fresnel(p, cosine)) * base;
        const Rgb cloth = sheen_colour(base, sheen_.eval(p.uv), sheen_tint_.eval(p.uv));
        const float reflected = 1.0f - 0.5f * diff_trans_.eval(p.uv);
        const Rgb diffuse = base + reflected * cloth * (0.088f * sqr(1.0f - cosine));
        return glm::min(glossy * facets + (1.0f - glossy) * diffuse, Rgb(1.0f));
    }

  private:
    struct Choice {
        float glossy, glossy_through, diffuse, diffuse_through;  ///< probabilities
    };

    Choice choice(const BsdfPoint& p) const {
        const float glossy = spec_trans_.eval(p.uv), through = 0.5f * diff_trans_.eval(p.uv);
        Choice c{0.5f * glossy * rates_.specular, 0.5f * glossy * rates_.specular_through,
                 (1.0f - glossy) * (1.0f - through) * rates_.diffuse,
                 (1.0f - glossy) * through * rates_.diffuse_through};
        const float sum = c.glossy + c.glossy_through + c.diffuse + c.diffuse_through;
        if (!(sum > 0.0f)) return {0.0f, 0.0f, 0.0f, 0.0f};
        for (float* x : {&c.glossy, &c.glossy_through, &c.diffuse, &c.diffuse_through}) *x /= sum;
        return c;
    }
    /// Facets that light passes are rougher the higher their index (Burley 2015, Fig. 15).
    Microfacet facets_at(const BsdfPoint& p, bool transmitted) const {
        const float scale = transmitted ? 0.65f * eta_.eval(p.uv) - 0.35f : 1.0f;
        return principled_facets(scale * roughness_.eval(p.uv), anisotropic_.eval(p.uv));
    }
    /// Mitsuba lets light pass a facet only where the way on, not mirrored, is behind that facet, and has no
    /// such condition on the view. The transport of power is the adjoint: there the light's side is wo's.
    static bool facet_seen(const ThinPair& d, TransportMode mode) {
        if (!d.transmitted) return true;
        const Vec3& light = mode == TransportMode::radiance ? d.mirrored : d.wo;
        return light.x * d.half.x + light.y * d.half.y < light.z * d.half.z;
    }
    float fresnel(const BsdfPoint& p, float cosine) const {
        return fresnel_dielectric(cosine, eta_.eval(p.uv)).reflectance;
    }
    /// The exact Fresnel reflectance, blended with Schlick's for tinted reflection.
    Rgb reflectance(const BsdfPoint& p, const Rgb& base, float cosine) const {
        const Rgb exact(fresnel(p, cosine));
        const float tint = spec_tint_.eval(p.uv), eta = eta_.eval(p.uv);
        if (tint == 0.0f) return exact;
        return glm::mix(exact, schlick_reflectance(tint_of(base) * normal_reflectance(eta), cosine, eta),
                        tint);
    }

    PrincipledThinParameters::Rates rates_;
    TextureSlot base_color_;
    ScalarSlot roughness_, anisotropic_, spec_trans_, eta_, spec_tint_, sheen_, sheen_tint_, flatness_,
        diff_trans_;
};

}  // namespace

std::shared_ptr<Bsdf> make_principled_thin(const PrincipledThinParameters& parameters) {
    return std::make_shared<PrincipledThin>(parameters);
}

}  // namespace mote::core
