// Portable any-maps, P1 to P6, and float maps, Pf and PF, whose rows run from the bottom.
#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

bool is_space(std::uint32_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

class PnmReader {
  public:
    explicit PnmReader(const PictureFile& file) : file_(file), bytes_(file.bytes, 1) {}

    DecodedPicture run() {
        kind_ = char(bytes_.next());
        const std::int64_t width = number(), height = number();
        if (kind_ == 'f' || kind_ == 'F')
            return floats(make_room(file_, width, height, kind_ == 'F' ? 3 : 1, false));
        const bool bits = kind_ == '1' || kind_ == '4';
        const std::uint32_t max = bits ? 1 : number();
        if (max < 1 || max > 65535)
            throw InputError("damaged PNM file: a largest value of " + std::to_string(max));
        DecodedPicture picture =
            make_room(file_, width, height, kind_ == '3' || kind_ == '6' ? 3 : 1, max < 256);
        if (kind_ == '4')
            packed(picture);
        else
            for (float& value : picture.values) value = fraction(sample(max), max);
        if (bits)  // 1 is black
            for (float& value : picture.values) value = 1.0f - value;
        return picture;
    }

  private:
    /// The next byte that is no comment.
    std::uint32_t significant() {
        std::uint32_t c = bytes_.next();
        while (c == '#') {
            while (bytes_.next() != '\n') {
            }
            c = bytes_.next();
        }
        return c;
    }
    std::string word() {
        std::uint32_t c = significant();
        while (is_space(c)) c = significant();
        std::string text;
        for (;;) {
            text += char(c);
            if (text.size() > 32) throw InputError("damaged PNM file: a number is too long");
            if (bytes_.at_end()) return text;  // the last value of a text file
            c = bytes_.next();
            if (is_space(c)) return text;
        }
    }
    std::uint32_t number() {
        const std::string text = word();
        if (text.find_first_not_of("0123456789") != std::string::npos || text.size() > 9)
            throw InputError("damaged PNM file: '" + printable(text) + "' is no number");
        return std::uint32_t(std::atol(text.c_str()));
    }
    std::uint32_t sample(std::uint32_t max) {
        std::uint32_t value = 0;
        if (kind_ == '1') {  // digits need no space between them
            do value = significant();
            while (is_space(value));
            value -= '0';
        } else if (kind_ < '4') {
            value = number();
        } else {
            value = bytes_.next();
            if (max > 255) value = value << 8 | bytes_.next();
        }
        if (value > max) throw InputError("damaged PNM file: a value above " + std::to_string(max));
        return value;
    }
    /// Eight pixels a byte; each row begins with a byte of its own.
    void packed(DecodedPicture& picture) {
        float* to = picture.values.data();
        for (int y = 0; y < picture.height; ++y) {
            std::uint32_t byte = 0;
            for (int x = 0; x < picture.width; ++x, byte <<= 1) {
                if (x % 8 == 0) byte = bytes_.next();
                *to++ = float(byte >> 7 & 1u);
            }
        }
    }
    DecodedPicture floats(DecodedPicture picture) {
        const float scale = std::strtof(word().c_str(), nullptr);
        if (!std::isfinite(scale) || scale == 0.0f) throw InputError("damaged PFM file: its scale");
        const std::size_t stride = std::size_t(picture.width) * std::size_t(picture.channels);
        for (int y = picture.height - 1; y >= 0; --y)
            for (std::size_t x = 0; x < stride; ++x) {
                std::uint32_t bits = 0;
                for (int i = 0; i < 4; ++i)
                    bits |= bytes_.next()
                            << (8 * (scale < 0.0f ? i : 3 - i));  // negative: the low byte first
                picture.values[std::size_t(y) * stride + x] = std::bit_cast<float>(bits) * std::abs(scale);
            }
        return picture;
    }

    const PictureFile& file_;
    PictureBytes bytes_;
    char kind_ = 0;
};

}  // namespace

DecodedPicture decode_pnm(const PictureFile& file) { return PnmReader(file).run(); }

}  // namespace mote::core
