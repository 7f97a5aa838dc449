// Windows bitmaps (layout: BITMAPFILEHEADER and BITMAPINFOHEADER, learn.microsoft.com): palettes, plain or in
// runs, and colours of 16, 24 and 32 bits. Header, palette and every pixel are held against each other and
// the size of the file.
#include <array>
#include <bit>
#include <limits>
#include <string>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr std::int64_t bmp_file_header_bytes = 14, os2_bmp_header_bytes = 12, fields_at = 54;
enum BmpCompression : std::uint32_t { bmp_plain = 0, bmp_rle8 = 1, bmp_rle4 = 2, bmp_bit_fields = 3 };

[[noreturn]] void damaged_bmp(const std::string& what) { throw InputError("damaged BMP file: " + what); }

struct BmpHeader {
    std::int64_t width = 0, height = 0;  ///< pixels
    bool from_the_top = false;
    std::int64_t bits = 0;     ///< per pixel: 1, 4, 8, 16, 24 or 32
    std::int64_t colours = 0;  ///< in the palette; 0 without one
    bool runs = false;         ///< run-length encoded
};

class BmpReader {
  public:
    explicit BmpReader(const PictureFile& file) : picture_file_(file), file_(file.bytes) {}

    DecodedPicture run() {
        read_header();
        check_kind();
        read_palette_size();
        if (!found_.runs) check_rows();
        picture_ = make_room(picture_file_, found_.width, found_.height, found_.bits == 32 ? 4 : 3, true);
        if (found_.bits > 8)
            read_colours();
        else if (found_.runs)
            read_runs();
        else
            read_indices();
        return std::move(picture_);
    }

  private:
    std::int64_t size() const { return std::int64_t(file_.size()); }
    std::uint32_t byte(std::int64_t at) const {
        if (at < 0 || at >= size()) damaged_bmp("cut short");
        return std::to_integer<std::uint32_t>(file_[std::size_t(at)]);
    }
    std::uint32_t u16(std::int64_t at) const { return byte(at) | byte(at + 1) << 8; }
    std::uint32_t u32(std::int64_t at) const { return u16(at) | u16(at + 2) << 16; }

    void read_header() {
        if (size() < 2 || byte(0) != 'B' || byte(1) != 'M') throw InputError("not a BMP file");
        pixels_ = u32(10), header_ = u32(14);
        if (header_ != os2_bmp_header_bytes && header_ != 40 && header_ != 108 && header_ != 124)
            throw InputError("BMP file with a header of " + std::to_string(header_) +
                             " bytes, which is not known");
        if (bmp_file_header_bytes + header_ > size()) damaged_bmp("cut short in its header");
        if (header_ == os2_bmp_header_bytes) {
            found_.width = u16(18), found_.height = u16(20), found_.bits = u16(24);
            return;
        }
        found_.width = std::int32_t(u32(18)), found_.bits = u16(28), compression_ = u32(30);
        const std::int64_t height = std::int32_t(u32(22));  // negative: from the top
        found_.height = height < 0 ? -height : height, found_.from_the_top = height < 0;
        declared_colours_ = u32(46);
    }

    void check_kind() {
        if (found_.width < 1 || found_.height < 1 || found_.height > std::numeric_limits<std::int32_t>::max())
            damaged_bmp("a picture of " + size_text() + " pixels");
        const std::int64_t b = found_.bits;
        if (b != 1 && b != 4 && b != 8 && b != 16 && b != 24 && b != 32)
            damaged_bmp(std::to_string(b) + " bits per pixel");
        if (compression_ > bmp_bit_fields)
            throw InputError("BMP file with compression " + std::to_string(compression_) +
                             ", which is not known");
        if ((compression_ == bmp_rle8 && b != 8) || (compression_ == bmp_rle4 && b != 4) ||
            (compression_ == bmp_bit_fields && b != 16 && b != 32))
            damaged_bmp("compression " + std::to_string(compression_) + " of " + std::to_string(b) +
                        " bits per pixel");
        found_.runs = compression_ == bmp_rle8 || compression_ == bmp_rle4;
    }

    void read_palette_size() {
        const std::int64_t begin = bmp_file_header_bytes + header_;
        palette_end_ = begin;
        if (found_.bits <= 8) {
            const std::int64_t most = std::int64_t(1) << found_.bits;
            if (declared_colours_ > most)
                damaged_bmp("a palette of " + std::to_string(declared_colours_) + " colours for " +
                            std::to_string(found_.bits) + " bits per pixel");
            found_.colours = declared_colours_ == 0 ? most : declared_colours_;
            palette_end_ = begin + found_.colours * (header_ == os2_bmp_header_bytes ? 3 : 4);
            if (palette_end_ > size())
                damaged_bmp("a palette of " + std::to_string(found_.colours) + " colours does not fit in " +
                            std::to_string(size()) + " bytes");
        }
        if (pixels_ < palette_end_) damaged_bmp("its pixels begin within its header or palette");
    }

    /// Rows of pixels are padded to four bytes each.
    std::int64_t stride() const { return (found_.width * found_.bits + 31) / 32 * 4; }
    void check_rows() const {
        if (pixels_ > size() || found_.height > (size() - pixels_) / stride())
            damaged_bmp(size_text() + " pixels do not fit in " + std::to_string(size()) + " bytes");
    }
    void read_indices() {
        const std::int64_t bits = found_.bits, per_byte = 8 / bits, mask = (1 << bits) - 1;
        for (std::int64_t y = 0; y < found_.height; ++y)
            for (std::int64_t x = 0; x < found_.width; ++x) {
                const std::int64_t value = byte(pixels_ + y * stride() + x / per_byte);
                put_colour(x, y, value >> (8 - bits * (x % per_byte + 1)) & mask);
            }
    }
    void read_colours() {
        const bool fields = compression_ == bmp_bit_fields;
        std::array<std::uint32_t, 4> masks = {0xff0000u, 0xff00u, 0xffu, 0xff000000u};
        if (found_.bits == 16) masks = {0x7c00u, 0x3e0u, 0x1fu, 0u};
        for (std::size_t c = 0; fields && c < 3; ++c) masks[c] = u32(fields_at + 4 * std::int64_t(c));
        for (std::int64_t y = 0; y < found_.height; ++y)
            for (std::int64_t x = 0; x < found_.width; ++x) {
                const std::int64_t at = pixels_ + y * stride() + x * found_.bits / 8;
                const std::uint32_t value = found_.bits == 32   ? u32(at)
                                            : found_.bits == 24 ? u16(at) | byte(at + 2) << 16
                                                                : u16(at);
                float* to = pixel(x, y);
                for (int c = 0; c < picture_.channels; ++c) to[c] = masked(value, masks[std::size_t(c)]);
            }
    }
    static float masked(std::uint32_t value, std::uint32_t mask) {
        return mask == 0 ? 0.0f
                         : fraction((value & mask) >> std::countr_zero(mask), mask >> std::countr_zero(mask));
    }

    /// Pairs of bytes: a run of one value, or an escape (0: end of line, 1: end of picture, 2: a step, more:
    /// so many values, padded to two bytes). RLE4 has two values in a byte.
    void read_runs() {
        for (std::int64_t y = 0; y < found_.height; ++y)  // pixels that are stepped over
            for (std::int64_t x = 0; x < found_.width; ++x) put_colour(x, y, 0);
        std::int64_t at = pixels_, x = 0, y = 0;
        for (;;) {
            const std::int64_t count = byte(at), value = byte(at + 1);
            at += 2;
            if (count == 0 && value == 1) return;
            if (count == 0 && value == 0) {
                ++y, x = 0;
            } else if (count == 0 && value == 2) {
                x += byte(at), y += byte(at + 1);
                at += 2;
            } else {
                if (y >= found_.height) damaged_bmp("runs beyond its last row");
                const bool single = count == 0;
                for (std::int64_t i = 0, n = single ? value : count; i < n; ++i, ++x)
                    put_colour(x, y,
                               run_value(single ? byte(at + i * found_.bits / 8) : std::uint32_t(value), i));
                if (single) at += ((value * found_.bits + 7) / 8 + 1) / 2 * 2;
            }
        }
    }
    /// Value i of a run in this byte of it.
    std::int64_t run_value(std::uint32_t byte, std::int64_t i) const {
        return found_.bits == 8 ? byte : (i % 2 == 0 ? byte >> 4 : byte & 15u);
    }
    float* pixel(std::int64_t x, std::int64_t y) {
        const std::int64_t row = found_.from_the_top ? y : found_.height - 1 - y;
        return &picture_.values[std::size_t((row * found_.width + x) * picture_.channels)];
    }
    /// Pixels of a run past the end of its row are nowhere.
    void put_colour(std::int64_t x, std::int64_t y, std::int64_t index) {
        if (index >= found_.colours)
            damaged_bmp("a pixel of colour " + std::to_string(index) + " in a palette of " +
                        std::to_string(found_.colours));
        if (x >= found_.width) return;
        const std::int64_t bytes = header_ == os2_bmp_header_bytes ? 3 : 4;
        const std::int64_t at = bmp_file_header_bytes + header_ + index * bytes;
        float* to = pixel(x, y);
        for (std::int64_t c = 0; c < 3; ++c) to[c] = fraction(byte(at + 2 - c), 255);
    }
    std::string size_text() const {
        return std::to_string(found_.width) + " x " + std::to_string(found_.height);
    }

    const PictureFile& picture_file_;
    std::span<const std::byte> file_;
    BmpHeader found_;
    DecodedPicture picture_;
    std::int64_t pixels_ = 0, header_ = 0, palette_end_ = 0, declared_colours_ = 0;
    std::uint32_t compression_ = bmp_plain;
};

}  // namespace

DecodedPicture decode_bmp(const PictureFile& file) { return BmpReader(file).run(); }

}  // namespace mote::core
