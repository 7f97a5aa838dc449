// BSDF "plastic": a diffuse base under a smooth dielectric coating.
//
// Light enters with transmittance T(wi), is reflected by the base, and leaves with T(wo); what the coating
// reflects back inside is summed as a geometric series with the mean internal reflectance (Mitsuba's model).
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

class Plastic final : public Bsdf {
  public:
    explicit Plastic(const PlasticParameters& p)
        : eta_(p.int_ior / p.ext_ior),
          inv_eta2_(1.0f / sqr(eta_)),
          internal_(float(fresnel_diffuse_reflectance(1.0 / double(eta_)))),
          mean_transmittance_(float(1.0 - fresnel_diffuse_reflectance(double(eta_)))),
          nonlinear_(p.nonlinear),
          diffuse_(p.diffuse_reflectance),
          specular_(p.specular_reflectance) {
        const float d = average(diffuse_.mean()), s = average(specular_.mean());
        specular_weight_ = d + s > 0.0f ? s / (d + s) : 0.5f;
    }

    BsdfTraits traits() const override {
        return {.smooth = true, .delta = true, .textured = diffuse_.textured() || specular_.textured()};
    }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return Rgb(0.0f);
        return base(p) * ((1.0f - fresnel(wo)) * (1.0f - fresnel(wi)) * inv_eta2_ * inv_pi);
    }
    float pdf_solid_angle(const BsdfPoint&, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
        return (1.0f - specular_probability(fresnel(wo))) * cosine_hemisphere_pdf(wi);
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode) const override {
        if (!(wo.z > 0.0f)) return std::nullopt;
        const float f = fresnel(wo), specular = specular_probability(f);
        BsdfSample s{.wi = reflect_local(wo), .weight = Rgb(0.0f), .pdf_solid_angle = 0.0f};
        if (u_lobe < specular) {
            s.weight = specular_.eval(p.uv) * (f / specular);
            s.delta = true;
        } else {
            const float diffuse = 1.0f - specular;
            s.wi = square_to_cosine_hemisphere(u);
            s.pdf_solid_angle = diffuse * cosine_hemisphere_pdf(s.wi);
            if (diffuse > 0.0f)
                s.weight = base(p) * ((1.0f - f) * (1.0f - fresnel(s.wi)) * inv_eta2_ / diffuse);
        }
        if (is_black(s.weight)) return std::nullopt;
        return s;
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        if (!(wo.z > 0.0f)) return Rgb(0.0f);
        const float f = fresnel(wo);
        return f * specular_.eval(p.uv) + base(p) * ((1.0f - f) * inv_eta2_ * mean_transmittance_);
    }

  private:
    float fresnel(const Vec3& w) const { return fresnel_dielectric(std::fmin(w.z, 1.0f), eta_).reflectance; }
    /// The base with all orders of internal reflection.
    Rgb base(const BsdfPoint& p) const {
        const Rgb d = diffuse_.eval(p.uv);
        return nonlinear_ ? d / (Rgb(1.0f) - d * internal_) : d / (1.0f - internal_);
    }
    float specular_probability(float f) const {
        const float s = f * specular_weight_, d = (1.0f - f) * (1.0f - specular_weight_);
        return s + d > 0.0f ? s / (s + d) : 0.5f;
    }

    float eta_, inv_eta2_, internal_, mean_transmittance_, specular_weight_ = 0.5f;
    bool nonlinear_;
    TextureSlot diffuse_, specular_;
};

}  // namespace

std::shared_ptr<Bsdf> make_plastic(const PlasticParameters& parameters) {
    return std::make_shared<Plastic>(parameters);
}

const ParameterList<PlasticParameters>& plastic_rows() {
    using S = PlasticParameters;
    static const ParameterList<S> list{
        row("int_ior", &S::int_ior, between(0.01, 100),
            "Index of refraction of the coating: a number or a name."),
        row("ext_ior", &S::ext_ior, between(0.01, 100), "Index of refraction outside: a number or a name."),
        row("diffuse_reflectance", &S::diffuse_reflectance, between(0, 1), "Reflectance of the base."),
        row("specular_reflectance", &S::specular_reflectance, between(0, 1),
            "Factor on the coating's reflection."),
        row("nonlinear", &S::nonlinear, "Let multiple scattering inside shift the colour.")};
    return list;
}

void register_plastic(Registry& registry) {
    add_type(registry, Category::bsdf, "plastic", "A diffuse base under a smooth clear coating.",
             plastic_rows(), R"(<bsdf type="plastic">
    <rgb name="diffuse_reflectance" value="0.1, 0.27, 0.36"/>
    <float name="int_ior" value="1.9"/>
</bsdf>)",
             make_plastic);
}

}  // namespace mote::core
