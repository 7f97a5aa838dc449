// Bitmaps of any common kind as linear RGB: the kind is found from the first bytes.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <string_view>

#include "core/files/whole_file.h"
#include "core/formats/pictures/alpha_channel.h"
#include "core/formats/pictures/decoded_picture.h"
#include "core/formats/pictures/image_file.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

using Decoder = DecodedPicture (*)(const PictureFile&);

// Null for an OpenEXR, which has layers.
Decoder decoder_of(std::string_view head, const std::string& path) {
    const auto starts_with = [head](std::string_view magic) { return head.substr(0, magic.size()) == magic; };
    if (starts_with("\x76\x2f\x31\x01")) return nullptr;
    if (starts_with("\x89PNG\r\n\x1a\n")) return decode_png;
    if (starts_with("\xff\xd8\xff")) return decode_jpeg;
    if (starts_with("#?")) return decode_hdr;
    if (starts_with("BM")) return decode_bmp;
    if (head.size() > 2 && head[0] == 'P' && std::strchr("123456Ff", head[1])) return decode_pnm;
    // Targa files have no magic number at their start.
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    if (extension == ".tga") return decode_targa;
    throw InputError("not a picture of a known kind (OpenEXR, PNG, JPEG, Radiance HDR, PNM, PFM, BMP, TGA)");
}

// Interleaved channels to RGB: one or two channels are grey (and alpha), more are red, green, blue (and
// more).
std::vector<Rgb> to_rgb(const std::vector<float>& values, int channels) {
    const auto stride = std::size_t(channels);
    std::vector<Rgb> pixels(values.size() / stride);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float* v = values.data() + i * stride;
        pixels[i] = channels < 3 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
    }
    return pixels;
}

Bitmap to_bitmap(const DecodedPicture& picture, bool raw) {
    Bitmap bitmap{picture.width, picture.height, to_rgb(picture.values, picture.channels)};
    if (picture.eight_bits && !raw)
        for (Rgb& p : bitmap.pixels) p = {decode_srgb(p.x), decode_srgb(p.y), decode_srgb(p.z)};
    return bitmap;
}

// Luminance and chroma (Y, RY, BY) to RGB, with Rec. 709 weights as OpenEXR defines them.
std::vector<Rgb> from_luminance_chroma(const ImageChannels& image) {
    const std::vector<float>&y = *image.find("Y"), *ry = image.find("RY"), *by = image.find("BY");
    std::vector<Rgb> pixels(y.size());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!ry || !by) {
            pixels[i] = Rgb(y[i]);
            continue;
        }
        const float r = ((*ry)[i] + 1.0f) * y[i], b = ((*by)[i] + 1.0f) * y[i];
        pixels[i] = {r, (y[i] - 0.2126f * r - 0.0722f * b) / 0.7152f, b};
    }
    return pixels;
}

Bitmap bitmap_from_exr(const std::string& path, std::size_t max_pixels) {
    const ImageChannels image = read_exr(path);
    if (std::size_t(image.width) * std::size_t(image.height) > max_pixels)
        throw InputError("declares " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                         " pixels: more than " + std::to_string(max_pixels));
    Bitmap bitmap{image.width, image.height, image.rgb("")};
    if (bitmap.pixels.empty() && image.find("Y")) bitmap.pixels = from_luminance_chroma(image);
    if (bitmap.pixels.empty() && image.channels.size() == 1) {
        for (const float value : image.channels[0]) bitmap.pixels.emplace_back(value);
    }
    if (bitmap.pixels.empty()) throw InputError("OpenEXR file without channels R, G, B, or Y");
    return bitmap;
}

/// A picture other than an OpenEXR, which gives none.
std::optional<DecodedPicture> read_decoded(const std::string& path, std::size_t max_pixels) {
    const std::vector<std::byte> bytes = read_whole_file(path);
    const Decoder decode = decoder_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
    if (!decode) return std::nullopt;
    return decode({bytes, max_pixels});
}

Bitmap read(const std::string& path, bool raw, std::size_t max_pixels) {
    const auto picture = read_decoded(path, max_pixels);
    return picture ? to_bitmap(*picture, raw) : bitmap_from_exr(path, max_pixels);
}

std::vector<float> alpha_of(const std::string& path, std::size_t max_pixels) {
    const auto picture = read_decoded(path, max_pixels);
    if (!picture) {
        const ImageChannels image = read_exr(path);
        return image.find("A") ? *image.find("A") : std::vector<float>{};
    }
    if (picture->channels != 2 && picture->channels < 4) return {};
    const std::size_t stride = std::size_t(picture->channels), offset = stride == 2 ? 1 : 3;
    std::vector<float> alpha(picture->values.size() / stride);
    for (std::size_t i = 0; i < alpha.size(); ++i) alpha[i] = picture->values[i * stride + offset];
    return alpha;
}

/// Runs f; what it throws becomes an InputError that names the file.
template <typename F>
auto naming(const std::string& path, F&& f) {
    try {
        return f();
    } catch (const InputError& error) {
        if (!error.where().file.empty()) throw;
        throw InputError(error.what(), {path, 0});
    } catch (const std::bad_alloc&) {
        throw InputError("picture needs more memory than there is", {path, 0});
    } catch (const std::exception& error) {
        throw InputError("damaged picture: " + printable(error.what()), {path, 0});
    }
}

}  // namespace

Bitmap read_bitmap(const std::string& path, bool raw, std::size_t max_pixels) {
    return naming(path, [&] { return read(path, raw, max_pixels); });
}

std::vector<float> read_alpha(const std::string& path, std::size_t max_pixels) {
    return naming(path, [&] { return alpha_of(path, max_pixels); });
}

}  // namespace mote::core
