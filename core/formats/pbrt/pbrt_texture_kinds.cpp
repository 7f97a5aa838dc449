// Pictures and checkerboards: values, and their elements in our language.
#include "core/formats/pbrt/pbrt_texture_kinds.h"

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {

void add_pbrt_mapping(pugi::xml_node texture, const PbrtMapping& mapping, bool flip) {
    if (mapping == PbrtMapping{} && !flip) return;
    glm::dmat4 m(1.0);
    m[0][0] = mapping.scale.x, m[3][0] = mapping.offset.x;
    m[1][1] = flip ? -mapping.scale.y : mapping.scale.y;
    m[3][1] = flip ? 1.0 - mapping.offset.y : mapping.offset.y;
    add_transform(texture, "to_uv", Transform(m));
}

bool PbrtCheckerboard::add(pugi::xml_node parent, const std::string& name) const {
    if (!first_->constant() || !second_->constant()) return false;
    pugi::xml_node texture = add_object(parent, "texture", "checkerboard", name);
    add_rgb(texture, "color0", first_->value({})), add_rgb(texture, "color1", second_->value({}));
    add_pbrt_mapping(texture, doubled_, false);  // ours has two squares to the unit
    return true;
}

const Bitmap& PbrtImage::bitmap() const {
    if (!bitmap_) bitmap_ = std::make_shared<const Bitmap>(read_bitmap(s_.path, s_.raw));
    return *bitmap_;
}

Rgb PbrtImage::value(const glm::dvec2& uv) const {
    const Bitmap& b = bitmap();
    const glm::dvec2 st = s_.mapping.apply(uv);
    const auto wrapped = [&](double x, int n) {
        if (!s_.clamp) x -= std::floor(x / n) * n;
        return std::size_t(std::clamp(x, 0.0, double(n - 1)));
    };
    const double x = st.x * b.width - 0.5, y = (1.0 - st.y) * b.height - 0.5;
    const double x0 = std::floor(x), y0 = std::floor(y);
    const auto texel = [&](double i, double j) {
        return b.pixels[wrapped(j, b.height) * std::size_t(b.width) + wrapped(i, b.width)];
    };
    if (s_.nearest) return texel(std::floor(x + 0.5), std::floor(y + 0.5));
    const float fx = float(x - x0), fy = float(y - y0);
    return glm::mix(glm::mix(texel(x0, y0), texel(x0 + 1, y0), fx),
                    glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), fx), fy);
}

bool PbrtImage::add(pugi::xml_node parent, const std::string& name) const {
    pugi::xml_node texture = add_object(parent, "texture", "bitmap", name);
    add_value(texture, "string", "filename", s_.in_xml);
    if (s_.raw) add_value(texture, "boolean", "raw", "true");
    if (s_.nearest) add_value(texture, "string", "filter_type", "nearest");
    if (s_.clamp) add_value(texture, "string", "wrap_mode", "clamp");
    add_pbrt_mapping(texture, s_.mapping, true);  // our pictures have v downwards
    return true;
}

}  // namespace mote::core
