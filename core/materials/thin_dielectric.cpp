// BSDF "thindielectric": a thin pane. Light passes straight on; reflections between its two faces are summed.
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class ThinDielectric final : public Bsdf {
  public:
    explicit ThinDielectric(const DielectricParameters& p)
        : eta_(p.int_ior / p.ext_ior),
          reflectance_(p.specular_reflectance),
          transmittance_(p.specular_transmittance) {}

    BsdfTraits traits() const override {
        const Rgb passes = transmittance_.mean();
        return {.delta = true,
                .transmissive = true,
                .pane = true,
                .tints = transmittance_.textured() || passes.x != passes.y || passes.y != passes.z,
                .textured = reflectance_.textured() || transmittance_.textured()};
    }
    Rgb eval(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override { return Rgb(0.0f); }
    float pdf_solid_angle(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override {
        return 0.0f;
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2&,
                                     TransportMode) const override {
        if (wo.z == 0.0f) return std::nullopt;
        BsdfSample s{.wi = reflect_local(wo), .weight = reflectance_.eval(p.uv), .pdf_solid_angle = 0.0f};
        s.delta = true;
        if (u_lobe >= reflection_probability(wo)) {
            s.wi = -wo;
            s.weight = transmittance_.eval(p.uv);
            s.transmitted = true;
        }
        if (is_black(s.weight)) return std::nullopt;
        return s;
    }
    StraightPassage straight_passage(const BsdfPoint& p, const Vec3& wo) const override {
        if (wo.z == 0.0f) return {};
        return {reflection_probability(wo), transmittance_.eval(p.uv)};
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const float r = reflection_probability(wo);
        return r * reflectance_.eval(p.uv) + (1.0f - r) * transmittance_.eval(p.uv);
    }

  private:
    /// R + T R T + T R^3 T + ... = 2 R / (1 + R) with T = 1 - R: both faces and all orders.
    float reflection_probability(const Vec3& wo) const {
        const float r = fresnel_dielectric(std::fmin(std::fabs(wo.z), 1.0f), eta_).reflectance;
        return 2.0f * r / (1.0f + r);
    }

    float eta_;
    TextureSlot reflectance_, transmittance_;
};

}  // namespace

std::shared_ptr<Bsdf> make_thin_dielectric(const DielectricParameters& parameters) {
    return std::make_shared<ThinDielectric>(parameters);
}

void register_thin_dielectric(Registry& registry) {
    add_type(registry, Category::bsdf, "thindielectric",
             "A thin pane of glass: reflects like a mirror, or lets light pass straight on.",
             dielectric_rows(), R"(<bsdf type="thindielectric">
    <string name="int_ior" value="bk7"/>
</bsdf>)",
             make_thin_dielectric);
}

}  // namespace mote::core
