// 8-bit previews.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/files/atomic_file.h"
#include "core/formats/pictures/png_text.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

// Encoded in memory: the writer of PNG files does not notice a full disk, write_file_atomically() does.
std::vector<std::byte> encode(int width, int height, std::span<const std::uint8_t> rgb, bool srgb,
                              const std::map<std::string, std::string>& text) {
    const auto output = OIIO::ImageOutput::create("png");
    if (!output) throw InputError("cannot be written: OpenImageIO has no PNG writer");
    OIIO::Filesystem::IOVecOutput memory;
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    if (srgb) spec.attribute("oiio:ColorSpace", "sRGB");
    for (const auto& [key, value] : text) spec.attribute(key, value);
    spec.attribute("png:compressionLevel", 3);  // a tenth larger than the best, several times faster
    if (!output->set_ioproxy(&memory) || !output->open("preview.png", spec) ||
        !output->write_image(OIIO::TypeDesc::UINT8, rgb.data()) || !output->close())
        throw InputError("cannot be written: " + printable(output->geterror()));
    const auto bytes = std::as_bytes(std::span(memory.buffer()));
    return {bytes.begin(), bytes.end()};
}

}  // namespace

void write_png(const std::string& path, int width, int height, std::span<const Rgb> pixels, float exposure) {
    write_png(path, width, height, pixels, exposure, {});
}

void write_png(const std::string& path, int width, int height, std::span<const Rgb> pixels, float exposure,
               const std::map<std::string, std::string>& text) {
    if (width < 1 || height < 1 || pixels.size() != std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("the pixels do not fit the picture");
    const float scale = std::exp2(exposure);
    std::vector<std::uint8_t> bytes(3 * pixels.size());
    tbb::parallel_for(std::size_t(0), pixels.size(), [&](std::size_t i) {
        const Rgb shown = is_finite(pixels[i]) ? pixels[i] * scale : Rgb(1.0f, 0.0f, 1.0f);
        for (int c = 0; c < 3; ++c) bytes[3 * i + std::size_t(c)] = encode_srgb(shown[c]);
    });

    std::vector<std::byte> file;
    try {
        file = encode(width, height, bytes, true, text);
    } catch (const InputError& error) {
        throw InputError(error.what(), {path, 0});
    }
    write_file_atomically(path, file);
}

std::vector<std::byte> encode_png(int width, int height, std::span<const std::uint8_t> rgb, bool srgb) {
    if (width < 1 || height < 1 || rgb.size() != 3 * std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("the bytes do not fit the picture");
    return encode(width, height, rgb, srgb, {});
}

}  // namespace mote::core
