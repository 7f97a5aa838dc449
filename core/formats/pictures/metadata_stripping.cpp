// Walks over the chunks of PNG (ISO/IEC 15948) and the segments of JPEG (ITU-T T.81) files.
#include "core/formats/pictures/metadata_stripping.h"

#include <algorithm>
#include <cstring>
#include <string_view>

#include "core/objects/error.h"

namespace mote::core {

namespace {

std::uint32_t byte_at(std::span<const std::byte> bytes, std::size_t i) {
    return std::to_integer<std::uint32_t>(bytes[i]);
}
std::uint32_t big_endian_16(std::span<const std::byte> bytes, std::size_t i) {
    return byte_at(bytes, i) << 8 | byte_at(bytes, i + 1);
}
std::uint32_t big_endian_32(std::span<const std::byte> bytes, std::size_t i) {
    return big_endian_16(bytes, i) << 16 | big_endian_16(bytes, i + 2);
}
void append(std::vector<std::byte>& to, std::span<const std::byte> from) {
    to.insert(to.end(), from.begin(), from.end());
}

// Channels of a colour type of PNG (palettes are looked up to RGB).
std::int64_t png_channels(std::uint32_t color_type) {
    switch (color_type) {
        case 0:
            return 1;
        case 4:
            return 2;
        case 6:
            return 4;
        default:
            return 3;
    }
}

bool is_frame_header(std::uint32_t marker) {
    // SOF0 ... SOF15, among which DHT, JPG and DAC lie.
    return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}
bool is_metadata(std::uint32_t marker) {
    // APP1 ... APP15 but Adobe's APP14, which says how colours are coded, and comments.
    return (marker >= 0xe1 && marker <= 0xef && marker != 0xee) || marker == 0xfe;
}

// Where the entropy-coded data that starts at `begin` ends: at the next marker that is neither a stuffed zero
// nor a restart.
std::size_t end_of_scan(std::span<const std::byte> file, std::size_t begin) {
    for (std::size_t i = begin; i + 1 < file.size(); ++i) {
        if (byte_at(file, i) != 0xff) continue;
        const std::uint32_t marker = byte_at(file, i + 1);
        if (marker != 0x00 && marker != 0xff && (marker < 0xd0 || marker > 0xd7)) return i;
    }
    throw InputError("damaged JPEG file: cut short");
}

}  // namespace

StrippedImage strip_png(std::span<const std::byte> file) {
    constexpr std::size_t signature = 8, overhead = 12;  // length, type and check sum of a chunk
    StrippedImage image;
    append(image.bytes, file.first(std::min(signature, file.size())));
    for (std::size_t at = signature;;) {
        if (file.size() < at + overhead) throw InputError("damaged PNG file: cut short");
        const std::size_t length = big_endian_32(file, at);
        if (length > file.size() - at - overhead) throw InputError("damaged PNG file: cut short");
        const std::string_view type(reinterpret_cast<const char*>(file.data()) + at + 4, 4);
        if (image.width == 0) {
            if (type != "IHDR" || length != 13) throw InputError("damaged PNG file: no header");
            image.width = big_endian_32(file, at + 8), image.height = big_endian_32(file, at + 12);
            image.channels = png_channels(byte_at(file, at + 17));
            if (image.width == 0 || image.height == 0) throw InputError("damaged PNG file: no pixels");
        }
        if (type == "IHDR" || type == "PLTE" || type == "tRNS" || type == "IDAT" || type == "IEND")
            append(image.bytes, file.subspan(at, length + overhead));
        if (type == "IEND") return image;
        at += length + overhead;
    }
}

StrippedImage strip_jpeg(std::span<const std::byte> file) {
    StrippedImage image;
    append(image.bytes, file.first(std::min<std::size_t>(2, file.size())));  // SOI
    for (std::size_t at = 2;;) {
        if (file.size() < at + 2) throw InputError("damaged JPEG file: cut short");
        if (byte_at(file, at) != 0xff) throw InputError("damaged JPEG file: a marker is missing");
        const std::uint32_t marker = byte_at(file, at + 1);
        if (marker == 0xff) {  // padding
            ++at;
            continue;
        }
        if (marker == 0xd9) {  // end of image
            if (image.width == 0) throw InputError("damaged JPEG file: no frame");
            append(image.bytes, file.subspan(at, 2));
            return image;
        }
        if (file.size() < at + 4) throw InputError("damaged JPEG file: cut short");
        const std::size_t length = big_endian_16(file, at + 2);
        if (length < 2 || length > file.size() - at - 2) throw InputError("damaged JPEG file: cut short");
        if (is_frame_header(marker)) {
            if (length < 8 || image.width != 0) throw InputError("damaged JPEG file: bad frame header");
            image.height = big_endian_16(file, at + 5), image.width = big_endian_16(file, at + 7);
            image.channels = byte_at(file, at + 9);
            if (image.width == 0 || image.height == 0) throw InputError("damaged JPEG file: no pixels");
        }
        std::size_t end = at + 2 + length;
        if (marker == 0xda) end = end_of_scan(file, end);
        if (!is_metadata(marker)) append(image.bytes, file.subspan(at, end - at));
        at = end;
    }
}

}  // namespace mote::core
