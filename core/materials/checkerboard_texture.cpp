// Texture "checkerboard": two alternating colours.
#include <algorithm>

#include "core/materials/register_materials.h"
#include "core/materials/texture_rows.h"
#include "core/materials/textures.h"
#include "core/materials/uv_transform.h"

namespace mote::core {
namespace {

class CheckerboardTexture final : public Texture {
  public:
    CheckerboardTexture(TexturePtr color0, TexturePtr color1, const Transform& to_uv)
        : color0_(std::move(color0)), color1_(std::move(color1)), to_uv_(to_uv) {}

    Rgb eval(const TextureCoordinates& uv) const override { return (even(uv) ? color0_ : color1_)->eval(uv); }
    /// The other way round, as in Mitsuba 3.9 (docs/measurements/peers.md): color1 is the number at the
    /// origin.
    float scalar(const TextureCoordinates& uv) const override {
        return (even(uv) ? color1_ : color0_)->scalar(uv);
    }
    /// Mean over a whole number of squares.
    Rgb mean() const override { return 0.5f * (color0_->mean() + color1_->mean()); }
    Rgb mean_over(const SurfaceAttributes& a) const override {
        return 0.5f * (color0_->mean_over(a) + color1_->mean_over(a));
    }
    float maximum() const override { return std::max(color0_->maximum(), color1_->maximum()); }
    float minimum() const override { return std::min(color0_->minimum(), color1_->minimum()); }
    std::string file() const override {
        const auto other = color0_->file().empty() || color1_->maximum() > color0_->maximum();
        return (other ? color1_ : color0_)->file();
    }
    bool constant() const override {
        return color0_->constant() && color1_->constant() && color0_->mean() == color1_->mean();
    }

  private:
    /// In a square of the colour at the origin.
    bool even(const Vec2& uv) const {
        const glm::dvec2 p = to_uv_(uv);
        const bool u = p.x - std::floor(p.x) > 0.5, v = p.y - std::floor(p.y) > 0.5;
        return u == v;
    }

    TexturePtr color0_, color1_;
    UvTransform to_uv_;
};

}  // namespace

std::shared_ptr<Texture> make_checkerboard_texture(TexturePtr color0, TexturePtr color1,
                                                   const Transform& to_uv) {
    return std::make_shared<CheckerboardTexture>(std::move(color0), std::move(color1), to_uv);
}

void register_checkerboard_texture(Registry& registry) {
    struct Settings {
        TexturePtr color0 = make_constant_texture(Rgb(0.4f)), color1 = make_constant_texture(Rgb(0.2f));
        Transform to_uv;
    };
    add_type<Settings>(
        registry, Category::texture, "checkerboard",
        "Squares of two alternating colours, two by two in every unit of uv.",
        {row("color0", &Settings::color0, "Colour of the square at the origin."),
         row("color1", &Settings::color1, "Colour of its neighbours."),
         row("to_uv", &Settings::to_uv, "Applied to the uv coordinates first.")},
        R"(<texture type="checkerboard" name="reflectance">
    <rgb name="color0" value="0.7, 0.7, 0.7"/>
    <rgb name="color1" value="0.1, 0.1, 0.2"/>
    <transform name="to_uv"><scale x="10" y="10"/></transform>
</texture>)",
        [](const Settings& s) { return make_checkerboard_texture(s.color0, s.color1, s.to_uv); });
}

}  // namespace mote::core
