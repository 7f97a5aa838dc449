// BSDF "twosided": makes opaque BSDFs scatter on both sides of a surface.
#include <vector>

#include "core/materials/bsdfs.h"
#include "core/materials/nested_bsdf.h"
#include "core/materials/register_materials.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

/// Seen from behind, the frame is turned over by mirroring z, as Mitsuba does: textures and anisotropy keep
/// their orientation on the surface.
Vec3 mirrored(const Vec3& w) { return {w.x, w.y, -w.z}; }

class TwoSided final : public Bsdf {
  public:
    TwoSided(BsdfPtr front, BsdfPtr back) : front_(std::move(front)), back_(back ? std::move(back) : front_) {
        for (const BsdfPtr& side : {front_, back_})
            if (side->traits().transmissive)
                throw InputError("a twosided BSDF cannot hold one that transmits light");
        const BsdfTraits f = front_->traits(), b = back_->traits();
        traits_ = {.smooth = f.smooth || b.smooth,
                   .delta = f.delta || b.delta,
                   .diffuse = f.diffuse && b.diffuse,
                   .textured = f.textured || b.textured,
                   .anisotropic = f.anisotropic || b.anisotropic};
    }

    BsdfTraits traits() const override { return traits_; }  // found once: sides may be nested deep
    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
        if (wo.z > 0.0f) return front_->eval(p, wo, wi, mode);
        return back_->eval(p, mirrored(wo), mirrored(wi), mode);
    }
    Rgb eval_bound(const BsdfPoint& p, const Vec3& wo, const DirectionCone& wi) const override {
        if (wo.z > 0.0f) return front_->eval_bound(p, wo, wi);
        return back_->eval_bound(p, mirrored(wo), {mirrored(wi.axis), wi.angle});
    }
    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                          TransportMode mode) const override {
        if (wo.z > 0.0f) return front_->pdf_solid_angle(p, wo, wi, mode);
        return back_->pdf_solid_angle(p, mirrored(wo), mirrored(wi), mode);
    }
    BsdfValue eval_and_pdf(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                           TransportMode mode) const override {
        if (wo.z > 0.0f) return front_->eval_and_pdf(p, wo, wi, mode);
        return back_->eval_and_pdf(p, mirrored(wo), mirrored(wi), mode);
    }
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (wo.z > 0.0f) return front_->sample(p, wo, u_lobe, u, mode);
        auto s = back_->sample(p, mirrored(wo), u_lobe, u, mode);
        if (s) s->wi = mirrored(s->wi);
        return s;
    }
    std::optional<Rgb> diffuse_reflectance(const BsdfPoint& p, const Vec3& wo) const override {
        return wo.z > 0.0f ? front_->diffuse_reflectance(p, wo) : back_->diffuse_reflectance(p, mirrored(wo));
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        return wo.z > 0.0f ? front_->albedo(p, wo) : back_->albedo(p, mirrored(wo));
    }

  private:
    BsdfPtr front_, back_;
    BsdfTraits traits_;
};

std::shared_ptr<Bsdf> create_twosided(const NestedBsdfs& s, const Properties& p) {
    if (s.nested.size() > 2) throw InputError("twosided holds one BSDF or two, not more", s.nested[2].where);
    for (const auto& side : s.nested)
        if (side.object->traits().transmissive)
            throw InputError("a twosided BSDF cannot hold one that transmits light", side.where);
    if (s.nested.empty()) throw InputError("twosided needs a nested BSDF", p.where);
    return make_twosided(s.nested.front().object, s.nested.size() == 2 ? s.nested.back().object : nullptr);
}

}  // namespace

std::shared_ptr<Bsdf> make_twosided(BsdfPtr front, BsdfPtr back) {
    return std::make_shared<TwoSided>(std::move(front), std::move(back));
}

void register_twosided(Registry& registry) {
    add_type<NestedBsdfs>(registry, Category::bsdf, "twosided",
                          "Lets opaque BSDFs scatter on both sides: one for both, or one for each.",
                          {nested("bsdf", &NestedBsdfs::nested, Category::bsdf, "required",
                                  "One for both sides, or two: the front and the back (any names).")},
                          R"(<bsdf type="twosided">
    <bsdf type="diffuse">
        <rgb name="reflectance" value="0.4"/>
    </bsdf>
</bsdf>)",
                          create_twosided);
}

}  // namespace mote::core
