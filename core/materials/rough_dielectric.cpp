// BSDF "roughdielectric": reflection and refraction by a transparent microsurface (Walter 2007), single
// scattering.
#include "core/materials/bsdfs.h"
#include "core/materials/dielectric_facet.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

class RoughDielectric final : public Bsdf {
  public:
    RoughDielectric(const DielectricParameters& p, const Roughness& roughness)
        : eta_(p.int_ior / p.ext_ior),
          roughness_(roughness),
          reflectance_(p.specular_reflectance),
          transmittance_(p.specular_transmittance) {
        if (!(std::fabs(eta_ - 1.0f) > 1e-4f))
            throw InputError("a rough dielectric needs two different indices of refraction");
    }

    BsdfTraits traits() const override {
        return {.smooth = true,
                .transmissive = true,
                .textured = reflectance_.textured() || transmittance_.textured() || roughness_.textured(),
                .anisotropic = roughness_.anisotropic()};
    }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
        const Microfacet facets = roughness_.at(p.uv);
        const DielectricFacet f = dielectric_facet(facets, eta_, wo, wi);
        if (!(f.cos_o > 0.0f)) return Rgb(0.0f);
        const float area = facets.projected_area(wo) * facets.projected_area(wi);
        // Walter 2007, Eqs. 20 and 21 with G / (cos cos) = 1 / area; Eq. 21 is for radiance.
        const float scale = mode == TransportMode::radiance ? 1.0f / sqr(f.eta) : 1.0f;
        const Rgb weight = f.transmitted ? transmittance_.eval(p.uv) *
                                               (scale * (1.0f - f.reflectance) * f.jacobian * f.cos_o / area)
                                         : reflectance_.eval(p.uv) * (f.reflectance / (4.0f * area));
        const float peak = max_component(weight) * std::fabs(wi.z);
        return weight * facets.widened(peak, p.peak_limit).density(f.normal);
    }

    /// Walter 2007, Eq. 38 with the Jacobians of Eqs. 14 and 17, for visible normals.
    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        const Microfacet facets = roughness_.at(p.uv);
        const DielectricFacet f = dielectric_facet(facets, eta_, wo, wi);
        if (f.density == 0.0f) return 0.0f;
        const float area = facets.projected_area(wo);
        if (!f.transmitted) return f.reflectance * f.density / (4.0f * area);
        return (1.0f - f.reflectance) * f.density * f.jacobian * f.cos_o / area;
    }

    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (wo.z == 0.0f) return std::nullopt;
        const float side = wo.z > 0.0f ? 1.0f : -1.0f, eta = side > 0.0f ? eta_ : 1.0f / eta_;
        const Microfacet facets = roughness_.at(p.uv);
        const Vec3 m = side * facets.sample_visible(side * wo, u);  // on wo's side
        const float cos_o = std::fmin(glm::dot(wo, m), 1.0f);
        if (!(cos_o > 0.0f)) return std::nullopt;
        const auto fresnel = fresnel_dielectric(cos_o, eta);
        BsdfSample s{.wi = 2.0f * cos_o * m - wo, .weight = reflectance_.eval(p.uv), .pdf_solid_angle = 0.0f};
        if (u_lobe >= fresnel.reflectance) {
            s.wi = glm::normalize(refract(wo, m, cos_o, fresnel.cos_t, eta));
            s.weight = transmittance_.eval(p.uv) * (mode == TransportMode::radiance ? 1.0f / sqr(eta) : 1.0f);
            s.transmitted = true, s.eta = eta;
        }
        if ((s.wi.z * side > 0.0f) == s.transmitted || s.wi.z == 0.0f) return std::nullopt;  // masked: lost
        s.weight *= facets.masking(s.wi);
        s.pdf_solid_angle = pdf_solid_angle(p, wo, s.wi, mode);
        if (!(s.pdf_solid_angle > 0.0f) || is_black(s.weight)) return std::nullopt;
        return s;
    }

    /// Albedo of power, for the smooth surface.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const float eta = wo.z > 0.0f ? eta_ : 1.0f / eta_;
        const float f = fresnel_dielectric(std::fmin(std::fabs(wo.z), 1.0f), eta).reflectance;
        return f * reflectance_.eval(p.uv) + (1.0f - f) * transmittance_.eval(p.uv);
    }

  private:
    float eta_;  ///< inside over outside
    Roughness roughness_;
    TextureSlot reflectance_, transmittance_;
};

}  // namespace

std::shared_ptr<Bsdf> make_rough_dielectric(const DielectricParameters& parameters,
                                            const Roughness& roughness) {
    return std::make_shared<RoughDielectric>(parameters, roughness);
}

void register_rough_dielectric(Registry& registry) {
    struct Settings {
        DielectricParameters parameters;
        RoughnessSettings roughness;
    };
    add_type<Settings>(
        registry, Category::bsdf, "roughdielectric",
        "A rough boundary between transparent materials, such as ground glass.",
        {within(&Settings::parameters, dielectric_rows()), within(&Settings::roughness, roughness_rows())},
        R"(<bsdf type="roughdielectric">
    <string name="distribution" value="beckmann"/>
    <float name="alpha" value="0.2"/>
    <string name="int_ior" value="bk7"/>
    <string name="ext_ior" value="air"/>
</bsdf>)",
        [](const Settings& s, const Properties& p) {
            if (!(std::fabs(s.parameters.int_ior / s.parameters.ext_ior - 1.0f) > 1e-4f))
                throw InputError("'int_ior' and 'ext_ior' of a roughdielectric must differ", p.where);
            return make_rough_dielectric(s.parameters, roughness_of(s.roughness, p));
        });
}

}  // namespace mote::core
