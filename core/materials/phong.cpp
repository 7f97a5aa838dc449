// BSDF "phong": the modified, reciprocal Phong model of version 0.x of the scene language: a diffuse part and
// a lobe cos^n around the mirror direction (Lafortune & Willems 1994, Eq. 3).
#include <algorithm>

#include "core/materials/bsdfs.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

class Phong final : public Bsdf {
  public:
    explicit Phong(const PhongParameters& p)
        : exponent_(p.exponent), diffuse_(p.diffuse_reflectance), specular_(p.specular_reflectance) {
        scale_ = 1.0f / std::max(1.0f, diffuse_.maximum() + specular_.maximum());
        const float d = average(diffuse_.mean()), s = average(specular_.mean());
        specular_weight_ = d + s > 0.0f ? s / (d + s) : 0.5f;
    }

    BsdfTraits traits() const override {
        return {.smooth = true, .textured = diffuse_.textured() || specular_.textured()};
    }
    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return Rgb(0.0f);
        const Rgb specular = specular_.eval(p.uv);
        const float exponent = widened(max_component(specular) * scale_ * wi.z, p.peak_limit);
        const float lobe = (exponent + 2.0f) * inv_two_pi * cos_power(wo, wi, exponent);
        return scale_ * (diffuse_.eval(p.uv) * inv_pi + specular * lobe);
    }
    float pdf_solid_angle(const BsdfPoint&, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
        return specular_weight_ * (exponent_ + 1.0f) * inv_two_pi * cos_power(wo, wi, exponent_) +
               (1.0f - specular_weight_) * cosine_hemisphere_pdf(wi);
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (!(wo.z > 0.0f)) return std::nullopt;
        const Vec3 wi = u_lobe < specular_weight_ ? sample_lobe(wo, u) : square_to_cosine_hemisphere(u);
        const float pdf = pdf_solid_angle(p, wo, wi, mode);
        if (!(pdf > 0.0f)) return std::nullopt;
        const Rgb weight = eval(p, wo, wi, mode) * (wi.z / pdf);
        if (is_black(weight)) return std::nullopt;
        return BsdfSample{.wi = wi, .weight = weight, .pdf_solid_angle = pdf};
    }
    /// Upper bound: the lobe loses light below the horizon at grazing angles.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        return wo.z > 0.0f ? scale_ * (diffuse_.eval(p.uv) + specular_.eval(p.uv)) : Rgb(0.0f);
    }

  private:
    /// The exponent with which `weight` times the peak (n + 2) / 2 pi is at most `limit` [1/sr], or this one
    /// where it is smaller (Tokuyoshi & Ogaki 2012, Eq. 10, which has n + 1 for a lobe over half vectors).
    float widened(float weight, float limit) const {
        if (!(limit < infinity) || !(weight > 0.0f)) return exponent_;
        return std::max(0.0f, std::min(exponent_, 2.0f * pi * limit / weight - 2.0f));
    }
    /// cos^n of the angle between wi and the mirror direction. 1 - cos comes from the difference of the two,
    /// which keeps its precision in narrow lobes.
    static float cos_power(const Vec3& wo, const Vec3& wi, float exponent) {
        const Vec3 difference = reflect_local(wo) - wi;
        const float h = 0.5f * glm::dot(difference, difference);
        if (!(h < 1.0f)) return 0.0f;
        return std::exp(exponent * std::log1p(-h));
    }
    Vec3 sample_lobe(const Vec3& wo, const Vec2& u) const {
        const float h = -std::expm1(std::log1p(-u.x) / (exponent_ + 1.0f));  // 1 - cos
        const float r = safe_sqrt(h * (2.0f - h)), phi = 2.0f * pi * u.y;
        return Frame(reflect_local(wo)).to_world({r * std::cos(phi), r * std::sin(phi), 1.0f - h});
    }

    float exponent_, scale_ = 1.0f, specular_weight_ = 0.5f;
    TextureSlot diffuse_, specular_;
};

}  // namespace

std::shared_ptr<Bsdf> make_phong(const PhongParameters& parameters) {
    return std::make_shared<Phong>(parameters);
}

void register_phong(Registry& registry) {
    using S = PhongParameters;
    add_type<S>(
        registry, Category::bsdf, "phong",
        "The modified Phong model of version 0.x files: a diffuse part and a lobe around the mirror "
        "direction.",
        {row("exponent", &S::exponent, between(0, 1e6), "Sharpness of the lobe."),
         row("diffuse_reflectance", &S::diffuse_reflectance, between(0, 1),
             "Reflectance of the diffuse part."),
         row("specular_reflectance", &S::specular_reflectance, between(0, 1),
             "Reflectance of the lobe; when both add up to more than 1 they are scaled down.")},
        R"(<bsdf type="phong">
    <float name="exponent" value="100"/>
    <rgb name="diffuse_reflectance" value="0.4, 0.3, 0.2"/>
    <rgb name="specular_reflectance" value="0.3"/>
</bsdf>)",
        [](const S& s, const Properties& p) {
            if (s.diffuse_reflectance->maximum() + s.specular_reflectance->maximum() > 1.0f)
                p.warn("the reflectances of phong add up to more than 1 and are scaled down together");
            return make_phong(s);
        });
}

}  // namespace mote::core
