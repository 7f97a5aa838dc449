// Bitmaps of any common kind as linear RGB: OpenEXR through our own reader, all others through OpenImageIO.
//
// The kind is found from the first bytes, and only that kind's reader is called: OpenImageIO itself would try
// every reader it has, video and volumes included, on a file of an unknown kind.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <string_view>

#include "core/files/whole_file.h"
#include "core/formats/pictures/alpha_channel.h"
#include "core/formats/pictures/bmp_preflight.h"
#include "core/formats/pictures/image_file.h"
#include "core/formats/pictures/metadata_stripping.h"
#include "core/formats/pictures/quiet_stderr.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

// No lossless coder of these formats, nor JPEG, packs more pixels into a byte.
constexpr std::size_t max_ratio = 2048;
constexpr std::size_t small_enough_bytes = std::size_t(64) << 20;

// The name of the kind as OpenImageIO calls it, or nothing.
std::optional<std::string> kind_of(std::string_view head, const std::string& path) {
    const auto starts_with = [head](std::string_view magic) { return head.substr(0, magic.size()) == magic; };
    if (starts_with("\x76\x2f\x31\x01")) return "openexr";
    if (starts_with("\x89PNG\r\n\x1a\n")) return "png";
    if (starts_with("\xff\xd8\xff")) return "jpeg";
    if (starts_with("#?")) return "hdr";
    if (starts_with("BM")) return "bmp";
    if (head.size() > 2 && head[0] == 'P' && std::strchr("123456Ff", head[1])) return "pnm";
    // Targa files have no magic number at their start.
    std::string extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    if (extension == ".tga") return "targa";
    return std::nullopt;
}

void check_size(std::int64_t width, std::int64_t height, std::int64_t bytes_per_pixel, std::size_t file_size,
                std::size_t max_pixels) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1 || bytes_per_pixel < 1 || bytes_per_pixel > 64)
        throw InputError("damaged picture of " + size + " pixels");
    if (std::uint64_t(width) > max_pixels / std::uint64_t(height))
        throw InputError("declares " + size + " pixels: more than " + std::to_string(max_pixels));
    const std::size_t declared = std::size_t(width) * std::size_t(height) * std::size_t(bytes_per_pixel);
    if (declared > small_enough_bytes && declared / max_ratio > file_size)
        throw InputError("damaged picture: " + size + " pixels do not fit in " + std::to_string(file_size) +
                         " bytes");
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

/// Interleaved channels as they are stored.
struct Decoded {
    int width = 0, height = 0, channels = 0;
    bool eight_bits = false;
    std::vector<float> values;
};

Decoded decode(const std::string& kind, std::vector<std::byte> bytes, std::size_t file_size,
               std::size_t max_pixels) {
    const QuietStderr quiet;
    const auto input = OIIO::ImageInput::create(kind);
    if (!input) throw InputError("OpenImageIO has no reader for " + kind + " files");
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are stored
    // Three channels of every BMP with a palette: of runs with a grey one, versions of OpenImageIO before 2.4
    // write three where they made room for one.
    config.attribute("bmp:monochrome_detect", 0);
    if (!input->set_ioproxy(&memory)) throw InputError("OpenImageIO reads " + kind + " from files alone");
    // OpenImageIO reports that libpng failed; libpng has printed the reason.
    const auto damaged = [&] {
        const std::string printed = quiet.last_line(), reported = printable(input->geterror());
        return InputError("damaged picture: " + reported +
                          (printed.empty() ? "" : (reported.empty() ? "" : " ") + ("(" + printed + ")")));
    };
    if (!input->open("picture." + kind, spec, config)) throw damaged();
    check_size(spec.width, spec.height, std::int64_t(spec.pixel_bytes()), file_size, max_pixels);

    Decoded picture{spec.width, spec.height, spec.nchannels, spec.format == OIIO::TypeDesc::UINT8, {}};
    const std::size_t count = std::size_t(spec.width) * std::size_t(spec.height);
    picture.values.assign(count * std::size_t(spec.nchannels), 0.0f);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.values.data()) ||
        input->has_error())
        throw damaged();
    return picture;
}

Bitmap to_bitmap(const Decoded& picture, bool raw) {
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
    check_size(image.width, image.height, 1, std::numeric_limits<std::size_t>::max(), max_pixels);
    Bitmap bitmap{image.width, image.height, image.rgb("")};
    if (bitmap.pixels.empty() && image.find("Y")) bitmap.pixels = from_luminance_chroma(image);
    if (bitmap.pixels.empty() && image.channels.size() == 1) {
        for (const float value : image.channels[0]) bitmap.pixels.emplace_back(value);
    }
    if (bitmap.pixels.empty()) throw InputError("OpenEXR file without channels R, G, B, or Y");
    return bitmap;
}

/// A picture other than an OpenEXR, which gives none.
std::optional<Decoded> read_decoded(const std::string& path, std::size_t max_pixels) {
    std::vector<std::byte> bytes = read_whole_file(path);
    const auto kind = kind_of({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
    if (!kind)
        throw InputError(
            "not a picture of a known kind (OpenEXR, PNG, JPEG, Radiance HDR, PNM, PFM, BMP, TGA)");
    if (kind == "openexr") return std::nullopt;
    const std::size_t file_size = bytes.size();
    if (kind == "png" || kind == "jpeg") {
        StrippedImage stripped = kind == "png" ? strip_png(bytes) : strip_jpeg(bytes);
        check_size(stripped.width, stripped.height, stripped.channels, file_size, max_pixels);
        bytes = std::move(stripped.bytes);
    }
    if (kind == "bmp") {
        const BmpSummary bmp = check_bmp(bytes);
        check_size(bmp.width, bmp.height, bmp.bits == 32 ? 4 : 3, file_size, max_pixels);
    }
    return decode(*kind, std::move(bytes), file_size, max_pixels);
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
