// Constant textures, and textures as parameters: an rgb, a float or a nested texture.
#include "core/materials/textures.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

class ConstantTexture final : public Texture {
  public:
    explicit ConstantTexture(const Rgb& value) : value_(value) {}
    Rgb eval(const Vec2&) const override { return value_; }
    Rgb mean() const override { return value_; }
    float maximum() const override { return max_component(value_); }
    float minimum() const override { return min_component(value_); }
    bool constant() const override { return true; }

  private:
    Rgb value_;
};

}  // namespace

std::shared_ptr<Texture> make_constant_texture(const Rgb& value) {
    return std::make_shared<ConstantTexture>(value);
}

std::shared_ptr<Texture> texture_or_constant(const Properties& p, const std::string& name,
                                             const Rgb& default_value) {
    if (auto nested = p.child<Texture>(name)) return nested;
    return make_constant_texture(p.get_rgb(name, default_value));
}

std::shared_ptr<Texture> reflectance_texture(const Properties& p, const std::string& name,
                                             const Rgb& default_value) {
    auto nested = p.child<Texture>(name);
    if (!nested) return make_constant_texture(p.get_rgb_in(name, default_value, 0.0f, 1.0f));
    constexpr float rounding =
        1e-5f;  // conversions of file formats may miss 1 by a few units in the last place
    const float lower = nested->minimum(), upper = nested->maximum();
    if (!(lower >= 0.0f && upper <= 1.0f + rounding))
        throw InputError("the texture " +
                             (nested->file().empty() ? "" : "'" + printable(nested->file(), 300) + "' ") +
                             "of '" + name + "' has values from " + std::to_string(lower) + " to " +
                             std::to_string(upper) + " but they must lie between 0 and 1",
                         p.where_of(name));
    return nested;
}

}  // namespace mote::core
