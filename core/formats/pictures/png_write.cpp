// 8-bit previews, by libpng.
#include <png.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <new>
#include <stdexcept>

#include "core/files/atomic_file.h"
#include "core/formats/pictures/png_text.h"
#include "core/math/srgb.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr int compression = 3;  // a tenth larger than the best, several times faster

/// Into memory: libpng does not notice a full disk, write_file_atomically() does.
class PngWriter {
  public:
    PngWriter() {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, nullptr);
        if (png_) info_ = png_create_info_struct(png_);
        if (!info_) throw std::bad_alloc();
        png_set_write_fn(png_, this, write, nullptr);
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    std::vector<std::byte> run(int width, int height, std::span<const std::uint8_t> rgb, bool srgb,
                               std::span<png_text> text) {
        // A jump out of here must not pass a destructor: all that is owned is a member, or the caller's.
        if (setjmp(jump_) != 0) throw InputError("cannot be written: " + printable(message_));
        png_set_IHDR(png_, info_, png_uint_32(width), png_uint_32(height), 8, PNG_COLOR_TYPE_RGB,
                     PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
        png_set_compression_level(png_, compression);
        if (srgb) png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_ABSOLUTE);
        png_set_text(png_, info_, text.data(), int(text.size()));
        png_write_info(png_, info_);
        for (int y = 0; y < height; ++y) png_write_row(png_, &rgb[3 * std::size_t(y) * std::size_t(width)]);
        png_write_end(png_, info_);
        return std::move(bytes_);
    }

  private:
    static void fail(png_structp png, png_const_charp message) {
        auto& self = *static_cast<PngWriter*>(png_get_error_ptr(png));
        std::strncpy(self.message_, message, sizeof(message_) - 1);
        std::longjmp(self.jump_, 1);
    }
    static void write(png_structp png, png_bytep from, std::size_t count) {
        auto& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes_;
        const auto* begin = reinterpret_cast<const std::byte*>(from);
        bytes.insert(bytes.end(), begin, begin + count);
    }

    std::vector<std::byte> bytes_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::jmp_buf jump_;
    char message_[200] = {};
};

std::vector<std::byte> encode(int width, int height, std::span<const std::uint8_t> rgb, bool srgb,
                              std::map<std::string, std::string> text) {
    std::vector<png_text> chunks;
    for (const auto& [key, value] : text) {
        png_text chunk{};
        chunk.compression = PNG_TEXT_COMPRESSION_NONE;
        chunk.key = const_cast<char*>(key.c_str()), chunk.text = const_cast<char*>(value.c_str());
        chunk.text_length = value.size();
        chunks.push_back(chunk);
    }
    return PngWriter().run(width, height, rgb, srgb, chunks);
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
