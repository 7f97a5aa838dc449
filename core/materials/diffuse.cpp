// BSDF "diffuse": Lambertian reflection on the side of the normal, black on the other.
#include "core/materials/bsdfs.h"
#include "core/materials/lobe_bounds.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/math/warp.h"

namespace mote::core {
namespace {

class Diffuse final : public Bsdf {
  public:
    explicit Diffuse(TexturePtr reflectance) : reflectance_(std::move(reflectance)) {}

    BsdfTraits traits() const override {
        return {.smooth = true, .diffuse = true, .textured = reflectance_.textured()};
    }
    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return Rgb(0.0f);
        return reflectance_.eval(p.uv) * inv_pi;
    }
    Rgb eval_bound(const BsdfPoint& p, const Vec3& wo, const DirectionCone& wi) const override {
        return wo.z > 0.0f && reaches_up(wi) ? reflectance_.eval(p.uv) * inv_pi : Rgb(0.0f);
    }
    float pdf_solid_angle(const BsdfPoint&, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        return wo.z > 0.0f ? cosine_hemisphere_pdf(wi) : 0.0f;
    }
    BsdfValue eval_and_pdf(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return {Rgb(0.0f), 0.0f};
        return {reflectance_.eval(p.uv) * inv_pi, wi.z * inv_pi};
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float, const Vec2& u,
                                     TransportMode) const override {
        if (!(wo.z > 0.0f)) return std::nullopt;
        const Rgb reflectance = reflectance_.eval(p.uv);
        if (is_black(reflectance)) return std::nullopt;
        const Vec3 wi = square_to_cosine_hemisphere(u);
        return BsdfSample{.wi = wi, .weight = reflectance, .pdf_solid_angle = cosine_hemisphere_pdf(wi)};
    }
    std::optional<Rgb> diffuse_reflectance(const BsdfPoint& p, const Vec3& wo) const override {
        return wo.z > 0.0f ? reflectance_.eval(p.uv) : Rgb(0.0f);
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override { return *diffuse_reflectance(p, wo); }

  private:
    TextureSlot reflectance_;
};

}  // namespace

std::shared_ptr<Bsdf> make_diffuse(TexturePtr reflectance) {
    return std::make_shared<Diffuse>(std::move(reflectance));
}

void register_diffuse(Registry& registry) {
    struct Settings {
        TexturePtr reflectance = grey_texture(0.5f);
    };
    add_type<Settings>(registry, Category::bsdf, "diffuse",
                       "Lambertian reflection: the same brightness from everywhere, black from behind.",
                       {row("reflectance", &Settings::reflectance, between(0, 1),
                            "Fraction of the light that is reflected.")},
                       R"(<bsdf type="diffuse">
    <rgb name="reflectance" value="0.6, 0.4, 0.3"/>
</bsdf>)",
                       [](const Settings& s) { return make_diffuse(s.reflectance); });
}

}  // namespace mote::core
