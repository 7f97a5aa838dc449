// BSDF "dielectric": a perfectly smooth boundary between two transparent materials.
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class Dielectric final : public Bsdf {
  public:
    explicit Dielectric(const DielectricParameters& p)
        : eta_(p.int_ior / p.ext_ior),
          reflectance_(p.specular_reflectance),
          transmittance_(p.specular_transmittance) {}

    BsdfTraits traits() const override {
        return {.delta = true,
                .transmissive = true,
                .textured = reflectance_.textured() || transmittance_.textured()};
    }
    Rgb eval(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override { return Rgb(0.0f); }
    float pdf_solid_angle(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override {
        return 0.0f;
    }

    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2&,
                                     TransportMode mode) const override {
        const float cos_o = std::fmin(std::fabs(wo.z), 1.0f);
        if (!(cos_o > 0.0f)) return std::nullopt;
        const float eta = wo.z > 0.0f ? eta_ : 1.0f / eta_;  // far side over wo's side
        const auto fresnel = fresnel_dielectric(cos_o, eta);
        BsdfSample s{.wi = reflect_local(wo), .weight = reflectance_.eval(p.uv), .pdf_solid_angle = 0.0f};
        s.delta = true;
        if (u_lobe >= fresnel.reflectance) {
            // Radiance is squeezed into a smaller or spread over a larger solid angle: (n_o / n_i)^2 (Veach
            // 1997, Sec. 5.2).
            const float scale = mode == TransportMode::radiance ? 1.0f / sqr(eta) : 1.0f;
            s.wi = {-wo.x / eta, -wo.y / eta, -std::copysign(fresnel.cos_t, wo.z)};
            s.weight = transmittance_.eval(p.uv) * scale;
            s.transmitted = true, s.eta = eta;
        }
        if (is_black(s.weight) || s.wi.z == 0.0f) return std::nullopt;
        return s;
    }
    /// Albedo of power: without the factor on radiance.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const float eta = wo.z > 0.0f ? eta_ : 1.0f / eta_;
        const float f = fresnel_dielectric(std::fmin(std::fabs(wo.z), 1.0f), eta).reflectance;
        return f * reflectance_.eval(p.uv) + (1.0f - f) * transmittance_.eval(p.uv);
    }

  private:
    float eta_;  ///< inside over outside
    TextureSlot reflectance_, transmittance_;
};

}  // namespace

std::shared_ptr<Bsdf> make_dielectric(const DielectricParameters& parameters) {
    return std::make_shared<Dielectric>(parameters);
}

const ParameterList<DielectricParameters>& dielectric_rows() {
    using S = DielectricParameters;
    static const ParameterList<S> list{
        row("int_ior", &S::int_ior, between(0.01, 100),
            "Index of refraction inside (against the normal; of a pane): a number or a name."),
        row("ext_ior", &S::ext_ior, between(0.01, 100), "Index of refraction outside: a number or a name."),
        row("specular_reflectance", &S::specular_reflectance, between(0, 1), "Factor on reflected light."),
        row("specular_transmittance", &S::specular_transmittance, between(0, 1),
            "Factor on transmitted light.")};
    return list;
}

void register_dielectric(Registry& registry) {
    add_type(registry, Category::bsdf, "dielectric",
             "A smooth boundary between transparent materials such as glass and air.", dielectric_rows(),
             R"(<bsdf type="dielectric">
    <string name="int_ior" value="water"/>
    <float name="ext_ior" value="1.0"/>
</bsdf>)",
             make_dielectric);
}

}  // namespace mote::core
