// Reading and writing pictures; each result is made once.
#include "core/formats/gltf/gltf_textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/files/whole_file.h"
#include "core/formats/conversion/scene_xml.h"
#include "core/formats/pictures/alpha_channel.h"
#include "core/formats/pictures/image_file.h"
#include "core/objects/error.h"

namespace mote::core {
namespace {

namespace fs = std::filesystem;

enum Sampler : std::uint64_t {
    nearest = 9728,
    clamp_to_edge = 33071,
    mirrored_repeat = 33648,
    repeat = 10497
};

std::string extension_of(std::span<const std::byte> bytes) {
    const std::string_view head(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 4));
    return head.starts_with("\xff\xd8") ? ".jpg" : head.starts_with("\x89PNG") ? ".png" : ".picture";
}

std::string wrap_mode(std::uint64_t gl) {
    return gl == clamp_to_edge ? "clamp" : gl == mirrored_repeat ? "mirror" : "repeat";
}

bool eight_bits(const Bitmap& bitmap) {
    return std::all_of(bitmap.pixels.begin(), bitmap.pixels.end(), [](const Rgb& p) {
        const Rgb bytes = 255.0f * p;
        return max_component(glm::abs(bytes - glm::round(bytes))) < 1e-4f && min_component(p) >= 0.0f &&
               max_component(p) <= 1.0f;
    });
}

/// (u, v) scaled, then turned, then moved; v points down, and angles go counter-clockwise in the picture.
Transform texture_transform(const GltfValue& extension) {
    const auto offset = extension["offset"].numbers({0.0, 0.0}),
               scale = extension["scale"].numbers({1.0, 1.0});
    const double angle = extension["rotation"].number(0.0), c = std::cos(angle), s = std::sin(angle);
    glm::dmat4 m(1.0);
    m[0][0] = c * scale[0], m[1][0] = s * scale[1], m[3][0] = offset[0];
    m[0][1] = -s * scale[0], m[1][1] = c * scale[1], m[3][1] = offset[1];
    return Transform(m);
}

}  // namespace

std::optional<std::size_t> GltfTextures::image_of(const GltfValue& info) {
    const GltfValue textures = file_.root()["textures"];
    const auto number = info["index"].index_below(textures.size());
    if (!number) return std::nullopt;
    const GltfValue texture = textures.at(*number);
    const auto image = texture["source"].index_below(file_.root()["images"].size());
    if (!image)
        report_.fault(texture.title() + " has no picture of a kind that is read (PNG, JPEG)", "left out");
    return image;
}

std::size_t GltfTextures::uv_set(const GltfValue& info) {
    const std::uint64_t set = info["texCoord"].whole(0);
    return info["extensions"]["KHR_texture_transform"]["texCoord"].whole(set);
}

std::string GltfTextures::new_name(const std::string& extension) {
    return "texture_" + std::to_string(count_++) + extension;
}

/// The file that holds the picture; bytes of the glTF file are written out.
const std::string& GltfTextures::original(std::size_t image) {
    const auto it = originals_.find(image);
    if (it != originals_.end()) return it->second;
    const GltfFile::Image source = file_.image(image);
    std::string& path = originals_[image];
    if (source.path.empty() || copies_) {
        const std::vector<std::byte> copy =
            source.path.empty() ? std::vector<std::byte>{} : read_whole_file(source.path);
        const std::span<const std::byte> bytes = source.path.empty() ? source.bytes : copy;
        const std::string name =
            new_name(source.path.empty() ? extension_of(bytes) : fs::path(source.path).extension().string());
        folder_.write(name, bytes);
        path = folder_.path_of(name), named_[path] = prefix_ + name;
    } else {
        path = source.path, named_[path] = fs::absolute(path).string();
    }
    return path;
}

Bitmap GltfTextures::read(std::size_t image, bool raw) { return read_bitmap(original(image), raw); }

GltfTextures::Picture GltfTextures::once(const std::string& key, const std::function<Picture()>& make) {
    const auto it = made_.find(key);
    return it != made_.end() ? it->second : made_[key] = make();
}

/// Linear values: bytes where these hold them, else floats.
GltfTextures::Picture GltfTextures::write(const Bitmap& bitmap, bool grey) {
    const bool png = eight_bits(bitmap);
    const std::string name = new_name(png ? ".png" : ".exr");
    if (png) {
        std::vector<std::uint8_t> bytes;
        for (const Rgb& p : bitmap.pixels)
            for (int c = 0; c < 3; ++c) bytes.push_back(std::uint8_t(std::lround(255.0f * p[c])));
        folder_.write(name, encode_png(bitmap.width, bitmap.height, bytes, false));
        return {prefix_ + name, true};
    }
    ImageChannels image;
    image.width = bitmap.width, image.height = bitmap.height;
    if (grey) {
        std::vector<float> plane;
        for (const Rgb& p : bitmap.pixels) plane.push_back(p.x);
        image.add("Y", std::move(plane));
    } else {
        image.add_rgb("", bitmap.pixels);
    }
    write_exr(folder_.path_of(name), image);
    return {prefix_ + name, false};
}

GltfTextures::Picture GltfTextures::colours(std::size_t image, const Rgb& factor) {
    if (factor == Rgb(1.0f)) return {named_[original(image)], false};
    return once(fmt::format("colours {} {} {} {}", image, factor.x, factor.y, factor.z), [&] {
        Bitmap bitmap = read(image, false);
        for (Rgb& p : bitmap.pixels) p *= factor;
        return write(bitmap, false);
    });
}

std::optional<GltfTextures::Picture> GltfTextures::light(std::size_t image, const Rgb& factor) {
    const Picture picture = once(fmt::format("light {} {} {} {}", image, factor.x, factor.y, factor.z), [&] {
        Bitmap bitmap = read(image, false);
        for (Rgb& p : bitmap.pixels) p *= factor;
        const bool black = std::all_of(bitmap.pixels.begin(), bitmap.pixels.end(), is_black);
        return black ? Picture{} : write(bitmap, false);
    });
    return picture.file.empty() ? std::nullopt : std::optional(picture);
}

GltfTextures::Picture GltfTextures::channel(std::size_t image, int channel, double factor) {
    return once(fmt::format("channel {} {} {}", image, channel, factor), [&] {
        Bitmap bitmap = read(image, true);
        for (Rgb& p : bitmap.pixels) p = Rgb(std::clamp(p[channel] * float(factor), 0.0f, 1.0f));
        return write(bitmap, true);
    });
}

std::optional<GltfTextures::Picture> GltfTextures::opacity(std::size_t image, double factor,
                                                           std::optional<double> cutoff) {
    const Picture picture = once(fmt::format("alpha {} {} {}", image, factor, cutoff.value_or(-1.0)), [&] {
        Bitmap bitmap = read(image, true);
        const std::vector<float> alpha = read_alpha(original(image));
        bool opaque = true;
        for (std::size_t i = 0; i < bitmap.pixels.size(); ++i) {
            float a = float(factor) * (alpha.empty() ? 1.0f : alpha[i]);
            if (cutoff) a = a >= float(*cutoff) ? 1.0f : 0.0f;
            bitmap.pixels[i] = Rgb(std::clamp(a, 0.0f, 1.0f));
            opaque = opaque && bitmap.pixels[i].x == 1.0f;
        }
        return opaque ? Picture{} : write(bitmap, true);
    });
    return picture.file.empty() ? std::nullopt : std::optional(picture);
}

GltfTextures::Picture GltfTextures::normals(std::size_t image, double scale, bool turned) {
    if (scale == 1.0 && !turned) return {named_[original(image)], true};
    return once(fmt::format("normals {} {} {}", image, scale, turned), [&] {
        Bitmap bitmap = read(image, true);
        for (Rgb& p : bitmap.pixels) {
            Vec3 n = 2.0f * p - 1.0f;
            n.x *= float(scale), n.y *= float(turned ? -scale : scale);
            const float length = glm::length(n);
            // Bytes stay bytes where only the sign changes.
            if (scale != 1.0 && length > 0.0f) n /= length;
            p = 0.5f * n + 0.5f;
        }
        return write(bitmap, false);
    });
}

void GltfTextures::add(pugi::xml_node parent, const std::string& name, const GltfValue& info,
                       const Picture& picture) {
    pugi::xml_node node = add_object(parent, "texture", "bitmap", name);
    add_value(node, "string", "filename", picture.file);
    if (picture.raw) add_value(node, "boolean", "raw", "true");
    const GltfValue textures = file_.root()["textures"], samplers = file_.root()["samplers"];
    const GltfValue texture = textures.at(info["index"].index_below(textures.size()).value_or(0));
    if (const auto number = texture["sampler"].index_below(samplers.size())) {
        const GltfValue sampler = samplers.at(*number);
        const std::string u = wrap_mode(sampler["wrapS"].whole(repeat)),
                          v = wrap_mode(sampler["wrapT"].whole(repeat));
        if (u != v)
            report_.fault(sampler.title() + " wraps u and v differently (" + u + ", " + v + ")",
                          "both are '" + u + "'");
        if (u != "repeat") add_value(node, "string", "wrap_mode", u);
        if (sampler["magFilter"].whole(0) == nearest) add_value(node, "string", "filter_type", "nearest");
    }
    const GltfValue transform = info["extensions"]["KHR_texture_transform"];
    if (transform.present()) add_transform(node, "to_uv", texture_transform(transform));
}

}  // namespace mote::core
