// Linear pictures inside an HTML page: shared-exponent RGB in an opaque 8-bit PNG of twice the height, which
// every browser can decode without loss.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace mote::trade {

struct Picture {
    int width = 0, height = 0;
    std::vector<core::Rgb> pixels;
};

/// Averages blocks of whole pixels until the picture is at most `width` wide.
Picture shrunk(const Picture& picture, int width);

/// Mantissas of red, green and blue in the upper half, the exponent in the lower (Ward 1991): a value is
/// (mantissa + 0.5) * 2^(exponent - 136), and 0 where the exponent is 0. Negative and not finite values: 0.
std::vector<std::uint8_t> pack_rgbe(const Picture& picture);

/// "data:image/png;base64,..." of the packed picture.
std::string data_url(const Picture& picture);
std::string base64(std::span<const std::byte> bytes);

}  // namespace mote::trade
