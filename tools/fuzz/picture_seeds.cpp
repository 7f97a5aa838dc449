// Sound pictures of 5 x 4 pixels, of each kind that has a decoder of its own.
#include <cstdio>

#include <jpeglib.h>

#include <cstdlib>

#include "core/formats/pictures/image_file.h"
#include "tools/fuzz/seeds.h"

namespace mote::fuzz {

namespace {

using namespace std::string_literals;

constexpr int width = 5, height = 4;

std::vector<std::uint8_t> gradient_bytes(int channels) {
    std::vector<std::uint8_t> values(std::size_t(width * height * channels));
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(11 * i);
    return values;
}
std::string gradient_text(int channels) {
    const auto values = gradient_bytes(channels);
    return {values.begin(), values.end()};
}

Bytes jpeg(int channels) {
    jpeg_compress_struct coder{};
    jpeg_error_mgr errors{};
    coder.err = jpeg_std_error(&errors);  // ends the program: nothing here can fail
    jpeg_create_compress(&coder);
    unsigned char* memory = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&coder, &memory, &size);
    coder.image_width = width, coder.image_height = height, coder.input_components = channels;
    coder.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&coder);
    if (channels == 3) jpeg_simple_progression(&coder);
    jpeg_start_compress(&coder, TRUE);
    auto pixels = gradient_bytes(channels);
    for (int y = 0; y < height; ++y) {
        JSAMPROW row = &pixels[std::size_t(y * width * channels)];
        jpeg_write_scanlines(&coder, &row, 1);
    }
    jpeg_finish_compress(&coder);
    jpeg_destroy_compress(&coder);
    const Bytes bytes(memory, memory + size);
    std::free(memory);
    return bytes;
}

/// `packed`: runs of 12 and 4 pixels a row.
Bytes hdr(bool packed) {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X "s + (packed ? "16" : "5") + "\n";
    for (int y = 0; y < height; ++y) {
        if (!packed) text += gradient_text(4).substr(0, std::size_t(4 * width));
        if (packed) text += "\2\2\0\20"s;
        for (int channel = 0; packed && channel < 4; ++channel) text += "\x8c\x81\4abcd"s;
    }
    return bytes_of(text);
}

void put(std::string& bytes, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += i < 4 ? char(value >> (8 * i) & 255u) : char(0);
}
Bytes bmp(std::uint32_t bits, std::uint32_t compression, const std::string& palette,
          const std::string& pixels) {
    std::string bytes = "BM";
    put(bytes, std::uint32_t(54 + palette.size() + pixels.size()), 4), put(bytes, 0, 4);
    put(bytes, std::uint32_t(54 + palette.size()), 4), put(bytes, 40, 4), put(bytes, width, 4),
        put(bytes, height, 4);
    put(bytes, 1, 2), put(bytes, bits, 2), put(bytes, compression, 4),
        put(bytes, std::uint32_t(pixels.size()), 4);
    put(bytes, 0, 8), put(bytes, bits <= 8 ? std::uint32_t(palette.size() / 4) : 0, 4), put(bytes, 0, 4);
    return bytes_of(bytes + palette + pixels);
}

Bytes targa(char kind, char bits, const std::string& pixels) {
    const bool palette = (kind & 7) == 1;
    std::string bytes =
        "\0"s + char(palette) + kind + "\0\0"s + (palette ? "\4\0\30"s : "\0\0\0"s) + "\0\0\0\0\5\0\4\0"s;
    bytes += bits, bytes += "\0"s;
    return bytes_of(bytes + (palette ? gradient_text(3).substr(0, 12) : "") + pixels);
}

}  // namespace

std::vector<Bytes> png_seeds() {
    const auto encoded = core::encode_png(width, height, gradient_bytes(3), true);
    const auto* begin = reinterpret_cast<const std::uint8_t*>(encoded.data());
    return {Bytes(begin, begin + encoded.size())};
}
std::vector<Bytes> jpeg_seeds() { return {jpeg(3), jpeg(1)}; }
std::vector<Bytes> hdr_seeds() { return {hdr(false), hdr(true)}; }
std::vector<Bytes> pnm_seeds() {
    return {bytes_of("P6\n5 4\n255\n" + gradient_text(3)), bytes_of("P5 5 4 65535\n" + gradient_text(2)),
            bytes_of("P2\n# grey\n2 2\n9\n0 1 2\n9\n"), bytes_of("P1\n5 2\n01010 11100\n"),
            bytes_of("P4\n5 4\nabcd")};
}
std::vector<Bytes> bmp_seeds() {
    const std::string four_colours = gradient_text(1).substr(0, 16);
    return {bmp(24, 0, "", std::string(64, 'x')),
            bmp(32, 0, "", gradient_text(4)),
            bmp(16, 3, "\0\xf8\0\0\xe0\7\0\0\37\0\0\0"s, std::string(48, 'y')),
            bmp(8, 0, four_colours, std::string(32, '\2')),
            bmp(8, 1, four_colours, "\5\1\0\0\0\3\0\1\2\0\2\3\0\2\1\1\4\0\0\1"s),
            bmp(4, 2, four_colours, "\5\x12\0\0\0\4\x10\x12\1\3\0\1"s)};
}
std::vector<Bytes> targa_seeds() {
    return {targa(2, 24, gradient_text(3)), targa(3, 8, gradient_text(1)), targa(2, 16, gradient_text(2)),
            targa(10, 32,
                  "\x87"
                  "abcd\x0b"s +
                      gradient_text(4).substr(0, 48)),
            targa(1, 8, std::string(20, '\3'))};
}

}  // namespace mote::fuzz
