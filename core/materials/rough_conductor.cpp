// BSDF "roughconductor": reflection by a metallic microsurface (Walter 2007), single scattering.
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/lobe_bounds.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class RoughConductor final : public Bsdf {
  public:
    RoughConductor(const ConductorParameters& p, const Roughness& roughness)
        : index_(p.index), roughness_(roughness), specular_(p.specular_reflectance) {}

    BsdfTraits traits() const override {
        return {.smooth = true,
                .textured = specular_.textured() || roughness_.textured(),
                .anisotropic = roughness_.anisotropic()};
    }

    /// Walter 2007, Eq. 20, with G = G1(wo) G1(wi).
    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return Rgb(0.0f);
        const Vec3 m = half_vector(wo, wi);
        const Microfacet facets = roughness_.at(p.uv);
        const Rgb weight = specular_.eval(p.uv) * fresnel(wo, m) /
                           (4.0f * facets.projected_area(wo) * facets.projected_area(wi));
        return weight * facets.widened(max_component(weight) * wi.z, p.peak_limit).density(m);
    }
    /// With a Fresnel reflectance of 1.
    Rgb eval_bound(const BsdfPoint& p, const Vec3& wo, const DirectionCone& wi) const override {
        if (!(wo.z > 0.0f && reaches_up(wi))) return Rgb(0.0f);
        return specular_.eval(p.uv) * LobeBound(roughness_.at(p.uv), wo, wi).facets();
    }
    /// Walter 2007, Eq. 38 with the Jacobian of Eq. 14, for visible normals: <wo, m> D / A(wo) / (4 <wo, m>).
    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode) const override {
        if (!(wo.z > 0.0f && wi.z > 0.0f)) return 0.0f;
        const Microfacet facets = roughness_.at(p.uv);
        return facets.density(half_vector(wo, wi)) / (4.0f * facets.projected_area(wo));
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float, const Vec2& u,
                                     TransportMode mode) const override {
        if (!(wo.z > 0.0f)) return std::nullopt;
        const Microfacet facets = roughness_.at(p.uv);
        const Vec3 m = facets.sample_visible(wo, u);
        const Vec3 wi = 2.0f * glm::dot(wo, m) * m - wo;
        if (!(wi.z > 0.0f)) return std::nullopt;  // would meet the surface again: lost
        const float pdf = pdf_solid_angle(p, wo, wi, mode);
        const Rgb weight = specular_.eval(p.uv) * fresnel(wo, m) * facets.masking(wi);
        if (!(pdf > 0.0f) || is_black(weight)) return std::nullopt;
        return BsdfSample{.wi = wi, .weight = weight, .pdf_solid_angle = pdf};
    }
    /// Without the loss between facets.
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        return wo.z > 0.0f ? specular_.eval(p.uv) * fresnel(wo, Vec3(0, 0, 1)) : Rgb(0.0f);
    }

  private:
    Rgb fresnel(const Vec3& wo, const Vec3& m) const {
        return fresnel_conductor(glm::clamp(glm::dot(wo, m), 0.0f, 1.0f), index_.eta, index_.k);
    }

    ComplexIndex index_;
    Roughness roughness_;
    TextureSlot specular_;
};

}  // namespace

std::shared_ptr<Bsdf> make_rough_conductor(const ConductorParameters& parameters,
                                           const Roughness& roughness) {
    return std::make_shared<RoughConductor>(parameters, roughness);
}

void register_rough_conductor(Registry& registry) {
    struct Settings {
        ConductorIndexSettings index;
        ConductorParameters parameters;
        RoughnessSettings roughness;
    };
    add_type<Settings>(
        registry, Category::bsdf, "roughconductor",
        "A rough metal: mirror-like facets whose slopes spread the reflection.",
        {within(&Settings::index, conductor_index_rows()), within(&Settings::parameters, conductor_rows()),
         within(&Settings::roughness, roughness_rows())},
        R"(<bsdf type="roughconductor">
    <string name="material" value="Al"/>
    <string name="distribution" value="ggx"/>
    <float name="alpha_u" value="0.05"/>
    <float name="alpha_v" value="0.3"/>
</bsdf>)",
        [](Settings s, const Properties& p) {
            s.parameters.index = conductor_index_of(s.index, p);
            return make_rough_conductor(s.parameters, roughness_of(s.roughness, p));
        });
}

}  // namespace mote::core
