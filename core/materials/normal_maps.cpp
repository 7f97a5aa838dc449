// BSDFs "normalmap" and "bumpmap": a picture of normals, or of heights, bends the normal of the nested BSDF.
#include "core/materials/bent_normal.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"

namespace mote::core {
namespace {

class NormalMap final : public BentNormal {
  public:
    NormalMap(BsdfPtr nested, TexturePtr normals, const BentNormalSettings& settings)
        : BentNormal(std::move(nested), settings, !normals->constant()), normals_(std::move(normals)) {}

  private:
    Vec3 normal(const BsdfPoint& p) const override { return 2.0f * normals_.eval(p.uv) - 1.0f; }

    TextureSlot normals_;
};

class BumpMap final : public BentNormal {
  public:
    BumpMap(BsdfPtr nested, TexturePtr heights, float scale, const BentNormalSettings& settings)
        : BentNormal(std::move(nested), settings, !heights->constant()),
          heights_(std::move(heights)),
          scale_(scale) {}

  private:
    /// Normal of the surface moved along its normal by the height, whose own derivatives are left out (Blinn
    /// 1978).
    Vec3 normal(const BsdfPoint& p) const override {
        const Vec2 slope = scale_ * heights_->scalar_gradient(p.uv);
        const Vec3 m = glm::cross(Vec3(p.dp_du.x, p.dp_du.y, slope.x), Vec3(p.dp_dv.x, p.dp_dv.y, slope.y));
        return glm::dot(m, p.geometric_normal) < 0.0f ? -m : m;
    }

    TexturePtr heights_;
    float scale_;
};

/// The settings that both share.
template <typename S>
Rows<S> bent_normal_rows() {
    return within(&S::bent,
                  row("flip_invalid_normals", &BentNormalSettings::flip_invalid_normals,
                      "Turn a normal over that the viewer would see from behind."),
                  row("use_shadowing_function", &BentNormalSettings::use_shadowing_function,
                      "Fade light that comes from near the horizon."));
}

}  // namespace

std::shared_ptr<Bsdf> make_normal_map(BsdfPtr nested, TexturePtr normals,
                                      const BentNormalSettings& settings) {
    return std::make_shared<NormalMap>(std::move(nested), std::move(normals), settings);
}
std::shared_ptr<Bsdf> make_bump_map(BsdfPtr nested, TexturePtr heights, float scale,
                                    const BentNormalSettings& settings) {
    return std::make_shared<BumpMap>(std::move(nested), std::move(heights), scale, settings);
}

void register_normal_map(Registry& registry) {
    struct Settings : NestedBsdfs {
        TexturePtr normals;
        BentNormalSettings bent;
    };
    add_type<Settings>(
        registry, Category::bsdf, "normalmap",
        "Bends the normal of the nested BSDF. Colours 0 to 1 are components -1 to 1 along dp/du, across it, "
        "and along the normal: (0.5, 0.5, 1) changes nothing. Pictures of normals want raw.",
        {row("normalmap", &Settings::normals, "The normals.").required(),
         nested("bsdf", &Settings::nested, Category::bsdf, "required", "The nested one (any name)."),
         bent_normal_rows<Settings>()},
        R"(<bsdf type="normalmap">
    <texture type="bitmap" name="normalmap">
        <string name="filename" value="normals.png"/>
        <boolean name="raw" value="true"/>
    </texture>
    <bsdf type="roughplastic"/>
</bsdf>)",
        [](const Settings& s, const Properties& p) {
            return make_normal_map(s.exactly(1, p)[0], s.normals, s.bent);
        });
}

void register_bump_map(Registry& registry) {
    struct Settings : NestedBsdfs {
        std::shared_ptr<Texture> heights;
        float scale = 1.0f;
        BentNormalSettings bent;
    };
    add_type<Settings>(
        registry, Category::bsdf, "bumpmap",
        "Bends the normal of the nested BSDF as if the surface were moved along its normal by the texture's "
        "height (of a picture its luminance), in metres times scale. Only slopes count, so nearest "
        "filtering and checkerboards have no effect. Pictures of heights want raw.",
        {nested("texture", &Settings::heights, Category::texture, "", "The heights (any name).").required(),
         row("scale", &Settings::scale, "Factor on the heights."),
         nested("bsdf", &Settings::nested, Category::bsdf, "required", "The nested one (any name)."),
         bent_normal_rows<Settings>()},
        R"(<bsdf type="bumpmap">
    <texture type="bitmap">
        <string name="filename" value="heights.png"/>
        <boolean name="raw" value="true"/>
    </texture>
    <float name="scale" value="0.1"/>
    <bsdf type="roughplastic"/>
</bsdf>)",
        [](const Settings& s, const Properties& p) {
            return make_bump_map(s.exactly(1, p)[0], s.heights, s.scale, s.bent);
        });
}

}  // namespace mote::core
