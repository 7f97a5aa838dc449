// The directive Texture by kind, and baking.
#include "core/formats/pbrt/pbrt_textures.h"

#include <algorithm>

#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pbrt/pbrt_texture_kinds.h"
#include "core/formats/pictures/image_file.h"

namespace mote::core {
namespace {

constexpr int max_texels = 2048;  // of a baked picture, along an axis

Rgb mix(const std::array<Rgb, 3>& v) { return glm::mix(v[0], v[1], v[2]); }
Rgb product(const std::array<Rgb, 3>& v) { return v[0] * v[1]; }

}  // namespace

PbrtTexturePtr pbrt_constant(const Rgb& value) { return std::make_shared<PbrtConstant>(value); }

PbrtTexturePtr pbrt_function(std::vector<PbrtTexturePtr> inputs, PbrtTextureFunction function) {
    const bool constant =
        std::all_of(inputs.begin(), inputs.end(), [](const PbrtTexturePtr& t) { return t->constant(); });
    auto texture = std::make_shared<PbrtFunction>(std::move(inputs), std::move(function));
    if (constant) return pbrt_constant(texture->value({}));
    return texture;
}

Rgb PbrtTexture::mean() const {
    constexpr int n = 32;
    if (constant() || !mapping()) return value({});
    Rgb sum(0.0f);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) sum += value(mapping()->invert(glm::dvec2(i + 0.5, j + 0.5) / double(n)));
    return sum / float(n * n);
}

PbrtMapping PbrtTextures::mapping_of(const PbrtObject& object) {
    const std::string kind = object.text("mapping", "uv");
    object.ignore({"v1", "v2"});
    const PbrtMapping m{{object.number("uscale", 1.0), object.number("vscale", 1.0)},
                        {object.number("udelta", 0.0), object.number("vdelta", 0.0)}};
    if (m.scale.x == 0.0 || m.scale.y == 0.0) throw InputError("a texture is scaled by 0", object.where);
    if (kind == "uv") return m;
    files_.fault(object.where,
                 "the mapping '" + printable(kind, 30) + "' of textures has no counterpart here",
                 "texture coordinates of the surface are used");
    return {};
}

PbrtTexturePtr PbrtTextures::make_image(const PbrtObject& object) {
    const PbrtParameter* file = object.find("filename");
    if (!file) throw InputError("an imagemap needs a filename", object.where);
    object.ignore({"maxanisotropy"});
    PbrtImage::Settings s;
    s.mapping = mapping_of(object);
    const std::string name = object.text("filename", ""), encoding = object.text("encoding", "sRGB");
    s.path = files_.find(name, file->where), s.in_xml = files_.use(name, file->where);
    s.nearest = object.text("filter", "bilinear") == "point";
    s.raw = encoding != "sRGB";
    const std::string wrap = object.text("wrap", "repeat");
    s.clamp = wrap != "repeat";
    if (wrap != "repeat" && wrap != "clamp")
        files_.fault(object.where,
                     "pictures wrapped as '" + printable(wrap, 30) + "' have no counterpart here",
                     "their border is repeated");
    auto image = std::make_shared<PbrtImage>(std::move(s));
    const float scale = float(object.number("scale", 1.0));
    const bool invert = object.flag("invert", false);
    const float gamma = encoding.starts_with("gamma ")
                            ? float(pbrt_number(std::string_view(encoding).substr(6), object.where))
                            : 1.0f;
    if (scale == 1.0f && !invert && gamma == 1.0f) return image;
    return pbrt_function({image}, [=](const std::array<Rgb, 3>& v) {
        const Rgb linear = gamma == 1.0f ? v[0] : glm::pow(glm::max(v[0], 0.0f), Rgb(gamma));
        return invert ? glm::max(Rgb(1.0f) - linear * scale, 0.0f) : linear * scale;
    });
}

PbrtTexturePtr PbrtTextures::make_checkerboard(const PbrtObject& object, bool spectrum) {
    if (object.integer("dimension", 2) != 2)
        return replaced(
            object, "their mean",
            pbrt_function({get(object, "tex1", 1.0, spectrum), get(object, "tex2", 0.0, spectrum)},
                          [](const auto& v) { return 0.5f * (v[0] + v[1]); }));
    const PbrtMapping m = mapping_of(object);
    return std::make_shared<PbrtCheckerboard>(m, get(object, "tex1", 1.0, spectrum),
                                              get(object, "tex2", 0.0, spectrum));
}

PbrtTexturePtr PbrtTextures::make_pattern(const PbrtObject& object, bool spectrum) {
    const PbrtMapping m = mapping_of(object);
    const auto corner = [&](const char* name, double d) { return get(object, name, d, spectrum)->value({}); };
    if (object.type == "bilerp") {
        const Rgb a = corner("v00", 0), b = corner("v10", 0), c = corner("v01", 1), d = corner("v11", 1);
        return std::make_shared<PbrtPattern>(m, [=](const glm::dvec2&, const glm::dvec2& st) {
            return glm::mix(glm::mix(a, b, float(st.x)), glm::mix(c, d, float(st.x)), float(st.y));
        });
    }
    const PbrtTexturePtr inside = get(object, "inside", 1.0, spectrum),
                         outside = get(object, "outside", 0.0, spectrum);
    return replaced(object, "regular dots",
                    std::make_shared<PbrtPattern>(m, [=](const glm::dvec2& uv, const glm::dvec2& st) {
                        const bool in = glm::length(st - glm::floor(st) - 0.5) < 0.35;
                        return (in ? inside : outside)->value(uv);
                    }));
}

PbrtTexturePtr PbrtTextures::replaced(const PbrtObject& object, const std::string& done, PbrtTexturePtr by) {
    files_.fault(object.where,
                 "a texture of type '" + printable(object.type, 30) + "' has no counterpart here",
                 done + " stand" + (done.back() == 's' ? "" : "s") + " in its place");
    return by;
}

PbrtTexturePtr PbrtTextures::make(const PbrtObject& object, bool spectrum) {
    const std::string& type = object.type;
    const auto input = [&](const char* name, double d) { return get(object, name, d, spectrum); };
    if (type == "constant") return input("value", 1.0);
    if (type == "imagemap") return make_image(object);
    if (type == "checkerboard") return make_checkerboard(object, spectrum);
    if (type == "bilerp" || type == "dots") return make_pattern(object, spectrum);
    if (type == "scale") return pbrt_function({input("tex", 1.0), get(object, "scale", 1.0, false)}, product);
    if (type == "mix")
        return pbrt_function({input("tex1", 0.0), input("tex2", 1.0), get(object, "amount", 0.5, false)},
                             mix);
    if (type == "directionmix") {
        object.ignore({"dir"});
        return replaced(object, "their mean",
                        pbrt_function({input("tex1", 0.0), input("tex2", 1.0)},
                                      [](const auto& v) { return 0.5f * (v[0] + v[1]); }));
    }
    static const std::map<std::string, Rgb> means = {{"fbm", Rgb(0.0f)},
                                                     {"wrinkled", Rgb(0.5f)},
                                                     {"windy", Rgb(0.1f)},
                                                     {"marble", Rgb(0.5f, 0.45f, 0.4f)},
                                                     {"ptex", Rgb(0.5f)}};
    std::vector<std::string> known = {"constant", "imagemap", "checkerboard", "bilerp",
                                      "dots",     "scale",    "mix",          "directionmix"};
    for (const auto& [name, mean] : means) known.push_back(name);
    const auto it = means.find(type);
    if (it == means.end())
        throw InputError("unknown texture '" + printable(type, 40) + "'" + suggestion(type, known),
                         object.where);
    object.ignore({"octaves", "roughness", "scale", "variation", "filename", "encoding"});
    return replaced(object, "its mean", pbrt_constant(it->second));
}

void PbrtTextures::define(const std::string& name, const std::string& value_type, const PbrtObject& object) {
    if (value_type != "float" && value_type != "spectrum")
        throw InputError("a texture is of 'float' or 'spectrum', not of '" + printable(value_type, 40) + "'",
                         object.where);
    const bool spectrum = value_type == "spectrum";
    auto& names = spectrum ? spectra_ : floats_;
    try {
        names[name] = make(object, spectrum);
        for (const InputError& error : object.unknown()) files_.fault(error, "ignored");
    } catch (const InputError& error) {
        files_.fault(error, "grey stands in its place");
        names[name] = pbrt_constant(Rgb(0.5f));
    }
}

PbrtTexturePtr PbrtTextures::named(const std::string& name, bool spectrum,
                                   const SourceLocation& where) const {
    const auto& names = spectrum ? spectra_ : floats_;
    if (const auto it = names.find(name); it != names.end()) return it->second;
    std::vector<std::string> known;
    for (const auto& [other, texture] : names) known.push_back(other);
    throw InputError("there is no " + std::string(spectrum ? "spectrum" : "float") + " texture '" +
                         printable(name, 60) + "'" + suggestion(name, known),
                     where);
}

PbrtTexturePtr PbrtTextures::find(const PbrtObject& object, const std::string& name, bool spectrum,
                                  bool reflectance) {
    const PbrtParameter* p = object.find(name);
    if (!p) return nullptr;
    if (p->type == "texture") return named(object.text(name, ""), spectrum, p->where);
    if (!spectrum) return pbrt_constant(Rgb(float(object.number(name, 0.0))));
    return pbrt_constant(pbrt_color_of(*p, files_, reflectance && p->type != "float"));
}

PbrtTexturePtr PbrtTextures::get(const PbrtObject& object, const std::string& name, double default_value,
                                 bool spectrum) {
    const PbrtTexturePtr texture = find(object, name, spectrum, false);
    return texture ? texture : pbrt_constant(Rgb(float(default_value)));
}

PbrtTexturePtr PbrtTextures::picture(const std::string& file, const SourceLocation& where, bool raw) {
    PbrtImage::Settings s;
    s.path = files_.find(file, where), s.in_xml = files_.use(file, where), s.raw = raw;
    return std::make_shared<PbrtImage>(std::move(s));
}

std::string PbrtTextures::bake(const PbrtTexture& texture, const PbrtMapping& mapping, bool reflectance) {
    const int n = std::min(texture.texels(), max_texels);
    std::vector<Rgb> pixels;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            pixels.push_back(texture.value(mapping.invert({(i + 0.5) / n, 1.0 - (j + 0.5) / n})));
    if (reflectance)
        for (Rgb& pixel : pixels) pixel = glm::clamp(pixel, 0.0f, 1.0f);  // as pbrt does where it is used
    ImageChannels image;
    image.width = image.height = n;
    image.add_rgb("", pixels);
    const std::string name = files_.new_name("texture", ".exr");
    write_exr(files_.path_of(name), image, true);
    return files_.in_xml(name);
}

void PbrtTextures::add(pugi::xml_node parent, const std::string& name, const PbrtTexturePtr& texture,
                       bool number) {
    if (texture->constant() || !texture->mapping()) {
        const Rgb value = texture->value({});
        return number ? add_float(parent, name, luminance(value)) : add_rgb(parent, name, value);
    }
    if (texture->add(parent, name)) return;
    const PbrtMapping mapping = *texture->mapping();
    if (!texture->only(mapping))
        files_.note("textures of different mappings are combined: the result repeats with the first one's");
    const bool reflectance = !number && std::string_view(parent.name()) == "bsdf";
    std::string& file = baked_[{texture.get(), reflectance}];
    if (file.empty()) file = bake(*texture, mapping, reflectance), kept_.push_back(texture);
    PbrtImage::Settings s;
    s.mapping = mapping, s.in_xml = file;
    PbrtImage(std::move(s)).add(parent, name);
}

}  // namespace mote::core
