// PNG and JPEG files without what is not pixels.
//
// OpenImageIO parses EXIF, IPTC, XMP and colour profiles when it opens a file, and damaged ones make it crash
// or hang (deeply nested XMP overflows its stack, an ICC profile trips an assertion). Pixels need none of
// them, so they are cut out in memory before OpenImageIO sees the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mote::core {

struct StrippedImage {
    std::int64_t width = 0, height = 0, channels = 0;  ///< as declared in the file
    std::vector<std::byte> bytes;
};

/// Keep only what decoding needs. Throw InputError (without the file's name) when the file is cut short or is
/// no sound sequence of chunks.
StrippedImage strip_png(std::span<const std::byte> file);
StrippedImage strip_jpeg(std::span<const std::byte> file);

}  // namespace mote::core
