// Targa files (Truevision): palettes, colours and grey, plain or run-length encoded.
#include <array>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

enum TargaKind : std::uint32_t { targa_palette = 1, targa_colour = 2, targa_grey = 3 };
constexpr std::uint32_t targa_encoded = 8, from_the_right = 16, from_the_top = 32;

using Pixel = std::array<float, 4>;

class TargaReader {
  public:
    explicit TargaReader(const PictureFile& file) : file_(file), bytes_(file.bytes) {}

    DecodedPicture run() {
        read_header();
        bytes_.skip(name_length_);
        for (std::uint32_t i = 0; i < colours_; ++i) palette_.push_back(value(palette_bits_));
        const std::uint32_t bits = kind_ == targa_palette ? palette_bits_ : bits_;
        const int channels = kind_ == targa_grey ? int(bits) / 8 : (bits == 32 ? 4 : 3);
        DecodedPicture picture = make_room(file_, width_, height_, channels, true);
        for (int i = 0; i < picture.height; ++i)
            for (int j = 0; j < picture.width; ++j) {
                const int x = (descriptor_ & from_the_right) ? picture.width - 1 - j : j;
                const int y = (descriptor_ & from_the_top) ? i : picture.height - 1 - i;
                const Pixel pixel = next_pixel();
                for (int c = 0; c < channels; ++c)
                    picture.values[(std::size_t(y) * std::size_t(picture.width) + std::size_t(x)) *
                                       std::size_t(channels) +
                                   std::size_t(c)] = pixel[std::size_t(c)];
            }
        return picture;
    }

  private:
    void read_header() {
        name_length_ = bytes_.next();
        const std::uint32_t has_palette = bytes_.next(), kind = bytes_.next();
        encoded_ = (kind & targa_encoded) != 0, kind_ = kind & ~targa_encoded;
        first_colour_ = bytes_.next_16(), colours_ = bytes_.next_16(), palette_bits_ = bytes_.next();
        bytes_.skip(4);  // where a screen would show it
        width_ = bytes_.next_16(), height_ = bytes_.next_16(), bits_ = bytes_.next(),
        descriptor_ = bytes_.next();
        const auto is_colour = [](std::uint32_t bits) {
            return bits == 15 || bits == 16 || bits == 24 || bits == 32;
        };
        const bool sound = kind_ == targa_palette
                               ? has_palette == 1 && is_colour(palette_bits_) && (bits_ == 8 || bits_ == 16)
                           : kind_ == targa_colour ? is_colour(bits_)
                                                   : kind_ == targa_grey && (bits_ == 8 || bits_ == 16);
        if (!sound || has_palette > 1 || (has_palette == 1 && !is_colour(palette_bits_)))
            throw InputError("damaged TGA file, or one of a kind that is not known");
        if (has_palette == 0) colours_ = 0;
    }
    Pixel value(std::uint32_t bits) {
        if (bits == 15 || bits == 16) {
            const std::uint32_t v = bytes_.next_16();
            return {fraction(v >> 10 & 31, 31), fraction(v >> 5 & 31, 31), fraction(v & 31, 31), 1.0f};
        }
        const float b = fraction(bytes_.next(), 255), g = fraction(bytes_.next(), 255),
                    r = fraction(bytes_.next(), 255);
        return {r, g, b, bits == 32 ? fraction(bytes_.next(), 255) : 1.0f};
    }
    Pixel stored() {
        if (kind_ == targa_colour) return value(bits_);
        if (kind_ == targa_grey) {
            const float grey = fraction(bytes_.next(), 255);
            return {grey, bits_ == 16 ? fraction(bytes_.next(), 255) : 1.0f, 0.0f, 0.0f};
        }
        const std::uint32_t index = bits_ == 8 ? bytes_.next() : bytes_.next_16();
        if (index < first_colour_ || index - first_colour_ >= palette_.size())
            throw InputError("damaged TGA file: a colour that its palette has not");
        return palette_[index - first_colour_];
    }
    /// Packets: a count, with one pixel for all (its highest bit set) or as many pixels.
    Pixel next_pixel() {
        if (!encoded_) return stored();
        if (left_ == 0) {
            const std::uint32_t head = bytes_.next();
            left_ = (head & 127) + 1, repeated_ = (head & 128) != 0;
            if (repeated_) pixel_ = stored();
        }
        --left_;
        return repeated_ ? pixel_ : stored();
    }

    const PictureFile& file_;
    PictureBytes bytes_;
    std::uint32_t name_length_ = 0, kind_ = 0, first_colour_ = 0, colours_ = 0, palette_bits_ = 0;
    std::uint32_t width_ = 0, height_ = 0, bits_ = 0, descriptor_ = 0, left_ = 0;
    bool encoded_ = false, repeated_ = false;
    std::vector<Pixel> palette_;
    Pixel pixel_{};
};

}  // namespace

DecodedPicture decode_targa(const PictureFile& file) { return TargaReader(file).run(); }

}  // namespace mote::core
