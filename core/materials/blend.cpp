// BSDFs "blendbsdf" and "mask": two BSDFs at once, each with a weight that may be textured. A mask is a blend
// of nothing at all, through which light passes straight on, and a BSDF.
#include <algorithm>
#include <array>

#include "core/materials/nested_bsdf.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class Blend final : public Bsdf {
  public:
    Blend(BsdfPtr first, BsdfPtr second, TexturePtr weight)
        : nested_{std::move(first), std::move(second)}, weight_(std::move(weight)) {
        const BsdfTraits a = nested_[0]->traits(), b = nested_[1]->traits();
        traits_ = {.smooth = a.smooth || b.smooth,
                   .delta = a.delta || b.delta,
                   .transmissive = a.transmissive || b.transmissive,
                   .null = a.null && b.null,
                   .pane = !(a.null && b.null) && (a.passes_straight() || b.passes_straight()),
                   .tints = a.tints || b.tints,
                   .diffuse = a.diffuse && b.diffuse,
                   .textured = a.textured || b.textured || weight_.textured(),
                   .anisotropic = a.anisotropic || b.anisotropic};
    }

    BsdfTraits traits() const override { return traits_; }

    Rgb eval(const BsdfPoint& p, const Vec3& wo, const Vec3& wi, TransportMode mode) const override {
        const std::array<float, 2> weight = weights(p);
        Rgb sum(0.0f);
        for (std::size_t k = 0; k < 2; ++k)
            if (weight[k] > 0.0f) sum += weight[k] * nested_[k]->eval(p, wo, wi, mode);
        return sum;
    }
    float pdf_solid_angle(const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                          TransportMode mode) const override {
        const std::array<float, 2> weight = weights(p);
        float sum = 0.0f;
        for (std::size_t k = 0; k < 2; ++k)
            if (weight[k] > 0.0f) sum += weight[k] * sampled_pdf(*nested_[k], p, wo, wi, mode);
        return sum;
    }

    /// u_lobe: first what the one scatters, then what the other scatters, last what passes either.
    std::optional<BsdfSample> sample(const BsdfPoint& p, const Vec3& wo, float u_lobe, const Vec2& u,
                                     TransportMode mode) const override {
        if (traits_.pane)
            if (const StraightPassage passage = straight_passage(p, wo); u_lobe >= passage.stops)
                return straight_sample(passage, wo);
        const std::array<float, 2> weight = weights(p);
        const float first = weight[0] * straight_passage_of(*nested_[0], p, wo).stops;
        const std::size_t k = u_lobe < first || weight[1] == 0.0f ? 0 : 1;
        const float stops = straight_passage_of(*nested_[k], p, wo).stops;
        const float within = stretched(k == 0 ? u_lobe : u_lobe - first, weight[k] * stops) * stops;
        auto s = nested_[k]->sample(p, wo, within, u, mode);
        if (!s || s->delta) return s;
        if (!nested_[1 - k]->traits().smooth) {
            s->pdf_solid_angle *= weight[k];
            return s;
        }
        // The other one could have sampled this direction too.
        s->pdf_solid_angle = pdf_solid_angle(p, wo, s->wi, mode);
        s->weight = eval(p, wo, s->wi, mode) * (std::fabs(s->wi.z) / s->pdf_solid_angle);
        return s;
    }

    StraightPassage straight_passage(const BsdfPoint& p, const Vec3& wo) const override {
        return mixed_passage(straight_passage_of(*nested_[0], p, wo), straight_passage_of(*nested_[1], p, wo),
                             weights(p)[1]);
    }
    std::optional<Rgb> diffuse_reflectance(const BsdfPoint& p, const Vec3& wo) const override {
        if (traits_.null) return std::nullopt;
        const std::array<float, 2> weight = weights(p);
        Rgb sum(0.0f);
        for (std::size_t k = 0; k < 2; ++k) {
            if (nested_[k]->traits().null) continue;  // scatters nothing
            const auto reflectance = nested_[k]->diffuse_reflectance(p, wo);
            if (!reflectance) return std::nullopt;
            sum += weight[k] * *reflectance;
        }
        return sum;
    }
    Rgb albedo(const BsdfPoint& p, const Vec3& wo) const override {
        const std::array<float, 2> weight = weights(p);
        return weight[0] * nested_[0]->albedo(p, wo) + weight[1] * nested_[1]->albedo(p, wo);
    }

  private:
    /// Density with which a part comes back with this direction: where it is black it samples nothing,
    /// whatever its density says (sample() of all kinds), and the other part has to make up for it.
    static float sampled_pdf(const Bsdf& part, const BsdfPoint& p, const Vec3& wo, const Vec3& wi,
                             TransportMode mode) {
        return is_black(part.eval(p, wo, wi, mode)) ? 0.0f : part.pdf_solid_angle(p, wo, wi, mode);
    }
    /// Weights of the first and the second. Textures may leave [0, 1], as in Mitsuba.
    std::array<float, 2> weights(const BsdfPoint& p) const {
        const float second = std::clamp(weight_.eval(p.uv), 0.0f, 1.0f);
        return {1.0f - second, second};
    }

    std::array<BsdfPtr, 2> nested_;
    ScalarSlot weight_;
    BsdfTraits traits_;
};

}  // namespace

std::shared_ptr<Bsdf> make_blend(BsdfPtr first, BsdfPtr second, TexturePtr weight) {
    return std::make_shared<Blend>(std::move(first), std::move(second), std::move(weight));
}
std::shared_ptr<Bsdf> make_mask(BsdfPtr nested, TexturePtr opacity) {
    return make_blend(make_null(), std::move(nested), std::move(opacity));
}

void register_blend(Registry& registry) {
    struct Settings : NestedBsdfs {
        TexturePtr weight = grey_texture(0.5f);
    };
    add_type<Settings>(
        registry, Category::bsdf, "blendbsdf",
        "Two BSDFs at once: (1 - weight) of the first and weight of the second.",
        {row("weight", &Settings::weight,
             "Weight of the second BSDF, clamped to 0 to 1; of a picture its luminance."),
         nested("bsdf", &Settings::nested, Category::bsdf, "required", "Two, in this order (any names).")},
        R"(<bsdf type="blendbsdf">
    <float name="weight" value="0.25"/>
    <bsdf type="diffuse"/>
    <bsdf type="roughconductor"/>
</bsdf>)",
        [](const Settings& s, const Properties& p) {
            const auto nested = s.exactly(2, p);
            return make_blend(nested[0], nested[1], s.weight);
        });
}

void register_mask(Registry& registry) {
    struct Settings : NestedBsdfs {
        TexturePtr opacity = grey_texture(0.5f);
    };
    add_type<Settings>(
        registry, Category::bsdf, "mask",
        "Holes in a surface: a fraction of the light passes straight on as if nothing were there, the rest "
        "meets the nested BSDF. What passes is no scattering and counts no depth, in all integrators, as "
        "through "
        "'thindielectric' (Mitsuba's volpath does the same; its path counts it). Such a surface is no area "
        "light.",
        {row("opacity", &Settings::opacity,
             "Weight of the nested BSDF, clamped to 0 to 1; of a picture its luminance."),
         nested("bsdf", &Settings::nested, Category::bsdf, "required",
                "The BSDF that the rest meets (any name).")},
        R"(<bsdf type="mask">
    <texture type="bitmap" name="opacity">
        <string name="filename" value="leaf.png"/>
    </texture>
    <bsdf type="twosided">
        <bsdf type="diffuse"/>
    </bsdf>
</bsdf>)",
        [](const Settings& s, const Properties& p) { return make_mask(s.exactly(1, p)[0], s.opacity); });
}

}  // namespace mote::core
