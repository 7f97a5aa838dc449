// False colours.
#include "core/metrics/error_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/math/srgb.h"
#include "core/metrics/relative_error.h"

namespace mote::core {

namespace {

/// sRGB, at equal distances; linear between them is within 2 of 255 of the whole table.
constexpr std::uint32_t viridis[] = {0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                     0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};
constexpr int last = int(std::size(viridis)) - 1;

Rgb srgb_entry(int i) {
    const std::uint32_t c = viridis[i];
    return {float(c >> 16 & 255u) / 255.0f, float(c >> 8 & 255u) / 255.0f, float(c & 255u) / 255.0f};
}

/// x in [0, 1].
Rgb colour(double x) {
    const int i = std::min(int(x * last), last - 1);
    const Rgb c = glm::mix(srgb_entry(i), srgb_entry(i + 1), float(x * last - i));
    return {decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)};
}

}  // namespace

std::vector<Rgb> error_map(std::span<const Rgb> image, std::span<const Rgb> reference, int width, int height,
                           const ErrorScale& scale) {
    if (image.size() != reference.size()) throw std::invalid_argument("the pictures differ in size");
    if (!(scale.lowest > 0.0 && scale.lowest < scale.highest))
        throw std::invalid_argument("the scale of an error map needs 0 < lowest < highest");
    const double decades = std::log(scale.highest / scale.lowest);
    std::vector<Rgb> finite(reference.begin(), reference.end());
    for (Rgb& r : finite)
        if (!is_finite(r)) r = Rgb(0.0f);
    const RelativeWeights weights = relative_weights(finite, width, height);
    std::vector<Rgb> map(image.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!is_finite(image[i]) || !is_finite(reference[i])) {
            map[i] = Rgb(1.0f, 0.0f, 1.0f);
            continue;
        }
        const double square = mean_square(glm::dvec3(image[i]) - glm::dvec3(reference[i]));
        const double relative = weights.norm > 0.0 ? weights.weight[i] * square : infinity;
        const double error = square > 0.0 ? std::sqrt(relative) : 0.0;
        map[i] = colour(std::clamp(std::log(error / scale.lowest) / decades, 0.0, 1.0));
    }
    return map;
}

}  // namespace mote::core
