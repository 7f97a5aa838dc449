// Checks of an untrusted BMP file before OpenImageIO reads it.
//
// OpenImageIO 2.4 trusts a BMP header: it decodes runs in a file of 24 bits with the palette that such a
// file has not, and reads in front of nothing. Earlier versions also take colours past a palette's end from
// what lies behind it. This walk holds the header, the palette and every pixel that names a colour against
// each other and against the size of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace mote::core {

struct BmpSummary {
    std::int64_t width = 0, height = 0;  ///< pixels
    std::int64_t bits = 0;               ///< per pixel: 1, 4, 8, 16, 24 or 32
    std::int64_t colours = 0;            ///< in the palette; 0 without one
    bool runs = false;                   ///< run-length encoded
};

/// Throws InputError, without the file's name, for anything that no sound file has, and for kinds of BMP that
/// OpenImageIO does not decode. The size of the picture has no limit here.
BmpSummary check_bmp(std::span<const std::byte> file);

}  // namespace mote::core
