// BSDF "roughplastic": a diffuse base under a rough dielectric coating.
//
// As "plastic", with transmittances of the rough coating from tables, and the coating's own reflection a
// glossy lobe (Walter 2007). Light that meets a second facet of the coating is lost, as in Mitsuba: a rough
// white plastic is grey. With `conserve_energy` it enters where it came from outside, and stays inside where
// it came from there: white plastic is white.
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/lobe_bounds.h"
#include "core/materials/register_materials.h"
#include "core/materials/rough_transmittance.h"
#include "core/materials/texture_slot.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

class RoughPlastic final : public Bsdf {
  public:
    RoughPlastic(const PlasticParameters& p, const Microfacet& microfacet)
        : eta_(p.int_ior / p.ext_ior),
          inv_eta2_(1.0f / sqr(eta_)),
          microfacet_(microfacet.kind(), microfacet.alpha_u()),
          transmittance_(microfacet_, eta_, p.conserve_energy ? LostLight::transmitted : LostLight::absorbed),
          // Light that does not leave is kept, and by reciprocity T(mu) / eta^2 is what leaves.
          internal_(p.conserve_energy ? 1.0f - inv_eta2_ * transmittance_.mean()
                                      : rough_internal_reflectance(microfacet_, eta_)),
          nonlinear_(p.nonlinear),
          diffuse_(p.diffuse_reflectance),
          specular_(p.specular_reflectance) {
        const float d = average(diffuse_.mean()), s = average(specular_.mean());
        specular_weight_ = d + s > 0.0f ? s / (d + s) : 0.5f;
    }

    BsdfTraits traits() const override {
        return {.smooth = true, .textured = diffuse_.textured() || specular_.textured()};
    }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return Rgb(0.0f);
        Rgb result = base(p) * (transmittance_(wo.z) * transmittance_(wi.z) * inv_eta2_ * inv_pi);
        const Vec3 m = half_vector(wo, wi);
        const float f = fresnel_dielectric(std::fmin(glm::dot(wo, m), 1.0f), eta_).reflectance;
        const Rgb weight = specular_.eval(p.uv) *
                           (f / (4.0f * microfacet_.projected_area(wo) * microfacet_.projected_area(wi)));
        return result + weight * microfacet_.widened(max_component(weight) * wi.z, p.peak_limit).density(m);
    }
    /// With a transmittance of 1 where the light enters.
    Rgb eval_bound(const BsdfPoint& p, const Vec3& wo, const DirectionCone& wi) const override {
        if (!(wo.z > 0.0f && reaches_up(wi))) return Rgb(0.0f);
        const LobeBound lobe(microfacet_, wo, wi);
        return base(p) * (transmittance_(wo.z) * inv_eta2_ * inv_pi) +
               specular_.eval(p.uv) * (lobe.facets() * dielectric_bound(lobe.min_cosine(), eta_));
    }
    float pdf_solid_angle(const BsdfPoint&, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
        const float specular = specular_probability(wo);
        const float d = microfacet_.density(half_vector(wo, wi));
        return specular * d / (4.0f * microfacet_.projected_area(wo)) +
               (1.0f - specular) * cosine_hemisphere_pdf(wi);
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (!(wo.z > 0.0f)) return std::nullopt;
        Vec3 wi;
        if (u_lobe < specular_probability(wo)) {
            const Vec3 m = microfacet_.sample_visible(wo, u);
            wi = 2.0f * glm::dot(wo, m) * m - wo;
        } else {
            wi = square_to_cosine_hemisphere(u);
        }
        const float pdf = pdf_solid_angle(p, wo, wi, mode);
        if (!(pdf > 0.0f)) return std::nullopt;
        const Rgb weight = eval(p, wo, wi, mode) * (wi.z / pdf);
        if (is_black(weight)) return std::nullopt;
        return BsdfSample{.wi = wi, .weight = weight, .pdf_solid_angle = pdf};
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        if (!(wo.z > 0.0f)) return Rgb(0.0f);
        const float t = transmittance_(wo.z);
        return (1.0f - t) * specular_.eval(p.uv) + base(p) * (t * inv_eta2_ * transmittance_.mean());
    }

  private:
    /// The base with all orders of internal reflection.
    Rgb base(const BsdfPoint& p) const {
        const Rgb d = diffuse_.eval(p.uv);
        return nonlinear_ ? d / (Rgb(1.0f) - d * internal_) : d / (1.0f - internal_);
    }
    float specular_probability(const Vec3& wo) const {
        const float t = transmittance_(wo.z);
        const float s = (1.0f - t) * specular_weight_, d = t * (1.0f - specular_weight_);
        return s + d > 0.0f ? s / (s + d) : 0.5f;
    }

    float eta_, inv_eta2_;
    Microfacet microfacet_;
    RoughTransmittance transmittance_;
    float internal_, specular_weight_ = 0.5f;
    bool nonlinear_;
    TextureSlot diffuse_, specular_;
};

}  // namespace

std::shared_ptr<Bsdf> make_rough_plastic(const PlasticParameters& parameters, const Microfacet& microfacet) {
    return std::make_shared<RoughPlastic>(parameters, microfacet);
}

void register_rough_plastic(Registry& registry) {
    struct Settings {
        PlasticParameters parameters;
        MicrofacetSettings microfacet;
    };
    add_type<Settings>(
        registry, Category::bsdf, "roughplastic", "A diffuse base under a rough clear coating.",
        {within(
             &Settings::parameters, plastic_rows(),
             row("conserve_energy", &PlasticParameters::conserve_energy,
                 "Keep the light that facets of the coating send to each other, which is lost otherwise; not "
                 "in Mitsuba.")),
         within(&Settings::microfacet, microfacet_rows())},
        R"(<bsdf type="roughplastic">
    <string name="distribution" value="beckmann"/>
    <float name="int_ior" value="1.61"/>
    <rgb name="diffuse_reflectance" value="0.07, 0.09, 0.13"/>
    <float name="alpha" value="0.3"/>
</bsdf>)",
        [](const Settings& s, const Properties& p) {
            return make_rough_plastic(s.parameters, microfacet_of(s.microfacet, p));
        });
}

}  // namespace mote::core
