// Parts that the decoders share.
#include "core/formats/pictures/decoded_picture.h"

#include "core/objects/error.h"

namespace mote::core {

namespace {

// No lossless coder of these formats, nor JPEG, packs more pixels into a byte.
constexpr std::size_t max_ratio = 2048;
constexpr std::size_t small_enough_bytes = std::size_t(64) << 20;
constexpr std::size_t max_line = 256;

}  // namespace

void check_picture_size(const PictureFile& file, std::int64_t width, std::int64_t height,
                        std::int64_t bytes_per_pixel) {
    const std::string size = std::to_string(width) + " x " + std::to_string(height);
    if (width < 1 || height < 1 || width > INT32_MAX || height > INT32_MAX || bytes_per_pixel < 1 ||
        bytes_per_pixel > 64)
        throw InputError("damaged picture of " + size + " pixels");
    if (std::uint64_t(width) > file.max_pixels / std::uint64_t(height))
        throw InputError("declares " + size + " pixels: more than " + std::to_string(file.max_pixels));
    const std::size_t declared = std::size_t(width) * std::size_t(height) * std::size_t(bytes_per_pixel);
    if (declared > small_enough_bytes && declared / max_ratio > file.bytes.size())
        throw InputError("damaged picture: " + size + " pixels do not fit in " +
                         std::to_string(file.bytes.size()) + " bytes");
}

DecodedPicture make_room(const PictureFile& file, std::int64_t width, std::int64_t height, int channels,
                         bool eight_bits) {
    check_picture_size(file, width, height, channels);
    DecodedPicture picture{int(width), int(height), channels, eight_bits, {}};
    picture.values.resize(std::size_t(width) * std::size_t(height) * std::size_t(channels));
    return picture;
}

std::uint32_t PictureBytes::next() {
    if (at_end()) throw InputError("damaged picture: cut short");
    return std::to_integer<std::uint32_t>(bytes_[at_++]);
}

void PictureBytes::skip(std::size_t count) {
    if (count > bytes_.size() - at_) throw InputError("damaged picture: cut short");
    at_ += count;
}

std::string PictureBytes::line() {
    std::string text;
    for (;;) {
        const std::uint32_t c = next();
        if (c == '\n') return text;
        if (text.size() == max_line) throw InputError("damaged picture: a line of its header is too long");
        text += char(c);
    }
}

}  // namespace mote::core
