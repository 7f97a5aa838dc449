// Shrinking, packing, base64.
#include "trade/packed_picture.h"

#include <algorithm>
#include <cmath>

#include "core/formats/pictures/image_file.h"

namespace mote::trade {

using core::Rgb;

Picture shrunk(const Picture& picture, int width) {
    const int f = (picture.width + width - 1) / width;
    if (f <= 1) return picture;
    Picture result{(picture.width + f - 1) / f, (picture.height + f - 1) / f, {}};
    for (int y = 0; y < picture.height; y += f)
        for (int x = 0; x < picture.width; x += f) {
            glm::dvec3 sum(0.0);
            const int x1 = std::min(x + f, picture.width), y1 = std::min(y + f, picture.height);
            for (int v = y; v < y1; ++v)
                for (int u = x; u < x1; ++u)
                    sum += glm::dvec3(
                        picture.pixels[std::size_t(v) * std::size_t(picture.width) + std::size_t(u)]);
            result.pixels.emplace_back(sum / double((x1 - x) * (y1 - y)));
        }
    return result;
}

std::vector<std::uint8_t> pack_rgbe(const Picture& picture) {
    const std::size_t n = picture.pixels.size();
    std::vector<std::uint8_t> bytes(6 * n, 0);
    for (std::size_t p = 0; p < n; ++p) {
        const Rgb c = picture.pixels[p];
        const float largest = std::max({c.x, c.y, c.z});
        if (!core::is_finite(c) || !(largest > 1e-32f)) continue;
        int exponent = 0;
        std::frexp(largest, &exponent);
        exponent = std::min(exponent, 127);
        for (int i = 0; i < 3; ++i) {
            const double mantissa = std::ldexp(double(std::max(c[i], 0.0f)), 8 - exponent);
            bytes[3 * p + std::size_t(i)] = std::uint8_t(std::min(255.0, mantissa));
            bytes[3 * (n + p) + std::size_t(i)] = std::uint8_t(exponent + 128);
        }
    }
    return bytes;
}

std::string base64(std::span<const std::byte> bytes) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < count; ++k) group |= std::uint32_t(bytes[i + k]) << (16 - 8 * k);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string data_url(const Picture& picture) {
    const auto bytes = pack_rgbe(picture);
    return "data:image/png;base64," +
           base64(core::encode_png(picture.width, 2 * picture.height, bytes, false));
}

}  // namespace mote::trade
