// Radiance pictures (Ward, "Real pixels", in the second volume of Graphics Gems): three mantissas and one
// exponent a pixel, plain or run-length encoded by channels.
#include <array>
#include <cmath>
#include <cstdio>

#include "core/formats/pictures/decoded_picture.h"
#include "core/objects/error.h"

namespace mote::core {

namespace {

constexpr int min_encoded = 8, max_encoded = 0x7fff;  // widths of rows that may be run-length encoded
constexpr std::uint32_t row_mark = 2, run_mark = 128;

using Rgbe = std::array<std::uint32_t, 4>;

void read_run_lengths(PictureBytes& bytes, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();) {
            std::uint32_t count = bytes.next();
            const bool run = count > run_mark;
            if (run) count -= run_mark;
            if (count == 0 || count > row.size() - x)
                throw InputError("damaged HDR file: a run past its row");
            std::uint32_t value = bytes.next();
            for (std::uint32_t i = 0; i < count; ++i) {
                if (i > 0 && !run) value = bytes.next();
                row[x++][channel] = value;
            }
        }
}

void read_row(PictureBytes& bytes, std::vector<Rgbe>& row) {
    const auto read = [&bytes] { return Rgbe{bytes.next(), bytes.next(), bytes.next(), bytes.next()}; };
    row[0] = read();
    const Rgbe& first = row[0];
    const bool encoded = int(row.size()) >= min_encoded && int(row.size()) <= max_encoded &&
                         first[0] == row_mark && first[1] == row_mark && (first[2] & 128u) == 0;
    if (!encoded) {
        for (std::size_t x = 1; x < row.size(); ++x) row[x] = read();
        return;
    }
    if ((first[2] << 8 | first[3]) != row.size())
        throw InputError("damaged HDR file: a row of another width");
    read_run_lengths(bytes, row);
}

}  // namespace

DecodedPicture decode_hdr(const PictureFile& file) {
    PictureBytes bytes(file.bytes);
    bool known = false;
    for (std::string line = bytes.line(); !line.empty(); line = bytes.line())
        known = known || line == "FORMAT=32-bit_rle_rgbe";
    if (!known) throw InputError("HDR file that does not say FORMAT=32-bit_rle_rgbe");
    char sign = 0;
    int width = 0, height = 0;
    if (std::sscanf(bytes.line().c_str(), "%cY %9d +X %9d", &sign, &height, &width) != 3 ||
        (sign != '-' && sign != '+'))
        throw InputError("HDR file whose rows run neither down nor up");
    DecodedPicture picture = make_room(file, width, height, 3, false);
    std::vector<Rgbe> row{std::size_t(width)};
    for (int i = 0; i < height; ++i) {
        read_row(bytes, row);
        float* to = &picture.values[3 * std::size_t(width) * std::size_t(sign == '-' ? i : height - 1 - i)];
        for (const Rgbe& pixel : row) {
            const float scale = pixel[3] == 0 ? 0.0f : std::ldexp(1.0f, int(pixel[3]) - (128 + 8));
            for (std::size_t c = 0; c < 3; ++c) *to++ = float(pixel[c]) * scale;
        }
    }
    return picture;
}

}  // namespace mote::core
