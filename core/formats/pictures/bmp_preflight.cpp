// The walk over a BMP file (layout: BITMAPFILEHEADER and BITMAPINFOHEADER, learn.microsoft.com).
#include "core/formats/pictures/bmp_preflight.h"

#include <limits>
#include <string>

#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr std::int64_t bmp_file_header_bytes = 14, os2_bmp_header_bytes = 12;
enum BmpCompression : std::uint32_t { bmp_plain = 0, bmp_rle8 = 1, bmp_rle4 = 2, bmp_bit_fields = 3 };

[[noreturn]] void damaged_bmp(const std::string& what) { throw InputError("damaged BMP file: " + what); }

class BmpWalker {
  public:
    explicit BmpWalker(std::span<const std::byte> file) : file_(file) {}

    BmpSummary run() {
        read_header();
        check_kind();
        read_palette_size();
        if (found_.runs)
            check_runs();
        else
            check_rows();
        return found_;
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
        found_.height = height < 0 ? -height : height;
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
        // OpenImageIO decodes runs from the end of the palette, wherever the header says that they are.
        if (found_.runs && pixels_ != palette_end_)
            throw InputError("BMP file with a gap between palette and runs, which cannot be read");
    }

    /// Rows of pixels, each padded to four bytes.
    void check_rows() const {
        const std::int64_t stride = (found_.width * found_.bits + 31) / 32 * 4;
        if (pixels_ > size() || found_.height > (size() - pixels_) / stride)
            damaged_bmp(size_text() + " pixels do not fit in " + std::to_string(size()) + " bytes");
        if (found_.bits > 8) return;
        const std::int64_t bits = found_.bits, per_byte = 8 / bits, mask = (1 << bits) - 1;
        if (found_.colours > mask) return;  // every value has a colour
        for (std::int64_t y = 0; y < found_.height; ++y)
            for (std::int64_t x = 0; x < found_.width; ++x) {
                const std::int64_t value = byte(pixels_ + y * stride + x / per_byte);
                check_colour(value >> (8 - bits * (x % per_byte + 1)) & mask);
            }
    }

    /// Pairs of bytes: a run of one value, or an escape (0: end of line, 1: end of picture, 2: a step, more:
    /// so many values, padded to two bytes). RLE4 has two values in a byte.
    void check_runs() const {
        std::int64_t at = pixels_, y = 0;
        for (;;) {
            const std::int64_t count = byte(at), value = byte(at + 1);
            at += 2;
            if (count == 0 && value == 1) return;
            if (count == 0 && value == 0) {
                ++y;
            } else if (count == 0 && value == 2) {
                y += byte(at + 1);
                at += 2;
            } else {
                if (y >= found_.height) damaged_bmp("runs beyond its last row");
                if (count > 0) {
                    check_values(value, count);
                } else {
                    const std::int64_t bytes = (value * found_.bits + 7) / 8;
                    for (std::int64_t i = 0; i < bytes; ++i)
                        check_values(byte(at + i), found_.bits == 8 ? 1 : value - 2 * i);
                    at += (bytes + 1) / 2 * 2;
                }
            }
        }
    }
    /// The first of up to `count` values in a byte of a run.
    void check_values(std::int64_t byte, std::int64_t count) const {
        if (found_.bits == 8) return check_colour(byte);
        check_colour(byte >> 4);
        if (count > 1) check_colour(byte & 15);
    }
    void check_colour(std::int64_t index) const {
        if (index >= found_.colours)
            damaged_bmp("a pixel of colour " + std::to_string(index) + " in a palette of " +
                        std::to_string(found_.colours));
    }
    std::string size_text() const {
        return std::to_string(found_.width) + " x " + std::to_string(found_.height);
    }

    std::span<const std::byte> file_;
    BmpSummary found_;
    std::int64_t pixels_ = 0, header_ = 0, palette_end_ = 0, declared_colours_ = 0;
    std::uint32_t compression_ = bmp_plain;
};

}  // namespace

BmpSummary check_bmp(std::span<const std::byte> file) { return BmpWalker(file).run(); }

}  // namespace mote::core
