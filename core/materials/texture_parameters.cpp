// Constant textures, and textures as parameters: an rgb, a float or a nested texture.
#include <fmt/format.h>

#include "core/materials/textures.h"
#include "core/objects/properties.h"

namespace mote::core {
namespace {

class ConstantTexture final : public Texture {
  public:
    explicit ConstantTexture(const Rgb& value) : value_(value) {}
    Rgb eval(const TextureCoordinates&) const override { return value_; }
    /// The mean of the channels as in Mitsuba, not the luminance; a grey one's exactly.
    float scalar(const TextureCoordinates&) const override {
        return value_.x == value_.y && value_.y == value_.z ? value_.x : average(value_);
    }
    Rgb mean() const override { return value_; }
    float maximum() const override { return max_component(value_); }
    float minimum() const override { return min_component(value_); }
    bool constant() const override { return true; }

  private:
    Rgb value_;
};

/// Throws InputError where `texture`, the parameter `name`, has values outside.
void require_range(const Texture& texture, const Properties& p, const std::string& name, float lower,
                   float upper) {
    constexpr float rounding =
        1e-5f;  // conversions of file formats may miss 1 by a few units in the last place
    const float least = texture.minimum(), most = texture.maximum();
    if (least >= lower && most <= upper + rounding) return;
    const std::string file = texture.file().empty() ? "" : "'" + printable(texture.file(), 300) + "' ";
    throw InputError(
        fmt::format("the texture {}of '{}' has values from {:f} to {:f} but they must lie between "
                    "{:g} and {:g}",
                    file, name, least, most, lower, upper),
        p.where_of(name));
}

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
    require_range(*nested, p, name, 0.0f, 1.0f);
    return nested;
}

std::shared_ptr<Texture> scalar_texture(const Properties& p, const std::string& name, float default_value,
                                        float lower, float upper) {
    auto nested = p.child<Texture>(name);
    if (!nested) return make_constant_texture(p.get_rgb_in(name, Rgb(default_value), lower, upper));
    require_range(*nested, p, name, lower, upper);
    return nested;
}

}  // namespace mote::core
