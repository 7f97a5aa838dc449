// BSDF "conductor": a perfectly smooth metal; reflects in the mirror direction only.
#include "core/materials/bsdfs.h"
#include "core/materials/fresnel.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class Conductor final : public Bsdf {
  public:
    explicit Conductor(const ConductorParameters& p) : index_(p.index), specular_(p.specular_reflectance) {}

    BsdfTraits traits() const override { return {.delta = true, .textured = specular_.textured()}; }
    Rgb eval(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override { return Rgb(0.0f); }
    float pdf_solid_angle(const BsdfPoint&, const Vec3&, const Vec3&, TransportMode) const override {
        return 0.0f;
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float, const Vec2&,
                                     TransportMode) const override {
        const Rgb weight = albedo(p, wo);
        if (is_black(weight)) return std::nullopt;
        return BsdfSample{.wi = reflect_local(wo), .weight = weight, .pdf_solid_angle = 0.0f, .delta = true};
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        if (!(wo.z > 0.0f)) return Rgb(0.0f);
        return specular_.eval(p.uv) * fresnel_conductor(std::fmin(wo.z, 1.0f), index_.eta, index_.k);
    }

  private:
    ComplexIndex index_;
    TextureSlot specular_;
};

}  // namespace

std::shared_ptr<Bsdf> make_conductor(const ConductorParameters& parameters) {
    return std::make_shared<Conductor>(parameters);
}

const ParameterList<ConductorParameters>& conductor_rows() {
    using S = ConductorParameters;
    static const ParameterList<S> list{
        row("specular_reflectance", &S::specular_reflectance, between(0, 1), "Factor on the reflection.")};
    return list;
}

void register_conductor(Registry& registry) {
    struct Settings {
        ConductorIndexSettings index;
        ConductorParameters parameters;
    };
    add_type<Settings>(
        registry, Category::bsdf, "conductor",
        "A smooth metal. Reflects in the mirror direction, on the side of the normal.",
        {within(&Settings::index, conductor_index_rows()), within(&Settings::parameters, conductor_rows())},
        R"(<bsdf type="conductor">
    <string name="material" value="Au"/>
</bsdf>)",
        [](Settings s, const Properties& p) {
            s.parameters.index = conductor_index_of(s.index, p);
            return make_conductor(s.parameters);
        });
}

}  // namespace mote::core
