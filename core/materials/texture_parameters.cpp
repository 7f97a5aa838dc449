// Constant textures, and textures as parameters: an rgb, a float or a nested texture.
#include <fmt/format.h>

#include "core/materials/texture_rows.h"

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

/// Throws InputError where the values of a nested texture leave the row's range.
void require_range(const Texture& texture, const Row& row, const SourceLocation& where) {
    constexpr float rounding =
        1e-5f;  // conversions of file formats may miss 1 by a few units in the last place
    const auto lower = float(row.parameter.range.lower), upper = float(row.parameter.range.upper);
    const float least = texture.minimum(), most = texture.maximum();
    if (least >= lower && most <= upper + rounding) return;
    const std::string file = texture.file().empty() ? "" : "'" + printable(texture.file(), 300) + "' ";
    throw InputError(fmt::format("the texture {}of '{}' has values from {:f} to {:f} but they {}", file,
                                 row.parameter.name, least, most, row.parameter.range.demand()),
                     where);
}

class TextureKind final : public ValueKind {
    std::string type(const Row&) const override { return "texture"; }
    void read(const Properties& p, const Row& row, void* member) const override {
        auto& texture = *static_cast<TexturePtr*>(member);
        texture = p.child<Texture>(row.parameter.name);
        if (texture)
            require_range(*texture, row, p.where_of(row.parameter.name));
        else
            texture = make_constant_texture(read_rgb(p, row));
    }
    std::string text(const Row&, const void* member) const override {
        const auto& texture = *static_cast<const TexturePtr*>(member);
        return texture ? rgb_text(texture->mean()) : "none";
    }
};

}  // namespace

std::shared_ptr<Texture> make_constant_texture(const Rgb& value) {
    return std::make_shared<ConstantTexture>(value);
}

const ValueKind& kind_of(Type<TexturePtr>) {
    static const TextureKind kind;
    return kind;
}

}  // namespace mote::core
