// BSDFs "normalmap" and "bumpmap": a picture of normals, or of heights, bends the normal of the nested BSDF.
#include "core/materials/bent_normal.h"
#include "core/materials/register_materials.h"
#include "core/materials/texture_slot.h"
#include "core/materials/textures.h"
#include "core/objects/error.h"
#include "core/objects/properties.h"

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
    /// Of the surface moved along its normal by the height, whose own derivatives are left out (Blinn 1978).
    Vec3 normal(const BsdfPoint& p) const override {
        const Vec2 slope = scale_ * heights_->scalar_gradient(p.uv);
        const Vec3 m = glm::cross(Vec3(p.dp_du.x, p.dp_du.y, slope.x), Vec3(p.dp_dv.x, p.dp_dv.y, slope.y));
        return glm::dot(m, p.geometric_normal) < 0.0f ? -m : m;
    }

    TexturePtr heights_;
    float scale_;
};

BentNormalSettings settings_of(const Properties& p) {
    return {p.get_bool("flip_invalid_normals", true), p.get_bool("use_shadowing_function", true)};
}

void append_settings(Manual& manual) {
    manual.parameters.push_back({"flip_invalid_normals", "boolean", "true",
                                 "turn a normal over that the viewer would see from behind"});
    manual.parameters.push_back(
        {"use_shadowing_function", "boolean", "true", "fade light that comes from near the horizon"});
}

std::shared_ptr<Texture> height_texture(const Properties& p) {
    auto heights = p.child_of<Texture>(Category::texture);
    if (!heights) throw InputError("bumpmap needs a nested texture", p.where);
    return heights;
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
    Manual manual{Category::bsdf,
                  "normalmap",
                  "Bends the normal of the nested BSDF. Colours 0 to 1 stand for components -1 to 1 along "
                  "dp/du, across "
                  "it, and along the normal: (0.5, 0.5, 1) changes nothing. Pictures of normals want raw.",
                  {{"normalmap", "texture", "", "the normals; required"},
                   {"bsdf", "bsdf", "", "the nested one (any name)"}},
                  R"(<bsdf type="normalmap">
    <texture type="bitmap" name="normalmap">
        <string name="filename" value="normals.png"/>
        <boolean name="raw" value="true"/>
    </texture>
    <bsdf type="roughplastic"/>
</bsdf>)"};
    append_settings(manual);
    registry.add(std::move(manual), [](const Properties& p) -> std::shared_ptr<Object> {
        if (!p.has("normalmap") && !p.child<Texture>("normalmap"))
            throw InputError("normalmap needs a texture 'normalmap'", p.where);
        return make_normal_map(nested_bsdfs(p, 1)[0], texture_or_constant(p, "normalmap", Rgb(0.0f)),
                               settings_of(p));
    });
}

void register_bump_map(Registry& registry) {
    Manual manual{
        Category::bsdf,
        "bumpmap",
        "Bends the normal of the nested BSDF as if the surface were moved along its normal by the texture's "
        "height (of a picture its luminance), in metres times scale. Only slopes count, so nearest "
        "filtering and checkerboards have no effect. Pictures of heights want raw.",
        {{"texture", "texture", "", "the heights; required (any name)"},
         {"scale", "float", "1", "factor on the heights"},
         {"bsdf", "bsdf", "", "the nested one (any name)"}},
        R"(<bsdf type="bumpmap">
    <texture type="bitmap">
        <string name="filename" value="heights.png"/>
        <boolean name="raw" value="true"/>
    </texture>
    <float name="scale" value="0.1"/>
    <bsdf type="roughplastic"/>
</bsdf>)"};
    append_settings(manual);
    registry.add(std::move(manual), [](const Properties& p) -> std::shared_ptr<Object> {
        const auto scale = float(p.get_float("scale", 1.0));
        return make_bump_map(nested_bsdfs(p, 1)[0], height_texture(p), scale, settings_of(p));
    });
}

}  // namespace mote::core
