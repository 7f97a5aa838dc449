#include "viewer/frame.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "session/layers.h"

namespace mote::viewer {

namespace {

const std::string deviation_layer = "standard deviation";

/// Layers that are no light of the sum, by the names that film_image() and make_picture() give.
bool is_light(const std::string& name) {
    static const char* const others[] = {"Variance", "Albedo",        "DiffuseAlbedo",
                                         "denoised", "Transmittance", "InScattered",
                                         "Center",   "Mirrored",      "MotionVector"};
    return std::ranges::none_of(
        others, [&](const std::string& other) { return name == other || name.starts_with(other + "."); });
}

bool is_rgb(const session::LayerChannels& layer) {
    return layer.channels == std::vector<std::string>{"R", "G", "B"};
}

/// 2^k near the mean of all that is finite and above 0.
float scale_of(const core::ImageChannels& image, const session::LayerChannels& layer) {
    double sum = 0.0;
    std::size_t count = 0;
    for (const std::size_t plane : layer.planes)
        for (const float v : image.channels[plane])
            if (v > 0.0f && std::isfinite(v)) sum += double(v), ++count;
    const double mean = count > 0 ? sum / double(count) : 1.0;
    return float(std::exp2(std::clamp(std::round(std::log2(mean)), -60.0, 60.0)));
}

}  // namespace

std::uint16_t to_half(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16 & 0x8000u, magnitude = bits & 0x7fffffffu;
    if (magnitude > 0x7f800000u) return std::uint16_t(sign | 0x7e00u);
    constexpr std::uint32_t max_half = 0x477fe000u;  // 65504
    if (magnitude >= max_half) return std::uint16_t(sign | 0x7bffu);
    constexpr std::uint32_t min_normal = 0x38800000u;  // 2^-14
    if (magnitude < min_normal)
        return std::uint16_t(sign | std::uint32_t(std::lrintf(std::fabs(value) * 0x1p24f)));
    return std::uint16_t(sign | ((magnitude - (112u << 23) + 0xfffu + (magnitude >> 13 & 1u)) >> 13));
}

std::vector<FrameLayer> frame_layers(const core::ImageChannels& image) {
    std::vector<FrameLayer> layers;
    bool variance = false;
    for (const session::LayerChannels& layer : session::layers_of(image)) {
        if (layer.name == "Variance" && is_rgb(layer)) variance = true;
        if (!is_rgb(layer) || layer.name == "Variance") continue;
        layers.push_back({layer.name, layer.name != session::beauty_layer && is_light(layer.name)});
    }
    std::ranges::stable_sort(layers, {}, [](const FrameLayer& l) {
        return l.name == session::beauty_layer ? 0 : l.of_sum ? 1 : 2;
    });
    if (variance) layers.push_back({deviation_layer, false});
    return layers;
}

SharedMessage encode_frame(const core::ImageChannels& image, nlohmann::json header) {
    const std::vector<FrameLayer> layers = frame_layers(image);
    const auto pixels = std::size_t(image.width) * std::size_t(image.height);
    const float scale =
        layers.empty() ? 1.0f : scale_of(image, session::find_layer(image, layers.front().name));
    std::string payload(layers.size() * pixels * 3 * sizeof(std::uint16_t), '\0');
    std::vector<std::uint16_t> halves(3 * pixels);
    header["layers"] = nlohmann::json::array();
    for (std::size_t l = 0; l < layers.size(); ++l) {
        const bool deviation = layers[l].name == deviation_layer;
        const session::LayerChannels layer =
            session::find_layer(image, deviation ? "Variance" : layers[l].name);
        for (std::size_t c = 0; c < 3; ++c) {
            const std::vector<float>& plane = image.channels[layer.planes[c]];
            for (std::size_t p = 0; p < pixels; ++p)
                halves[3 * p + c] = to_half((deviation ? std::sqrt(plane[p]) : plane[p]) / scale);
        }
        const std::size_t bytes = halves.size() * sizeof(std::uint16_t);
        std::memcpy(payload.data() + l * bytes, halves.data(), bytes);
        header["layers"].push_back({{"name", layers[l].name}, {"of_sum", layers[l].of_sum}});
    }
    header["width"] = image.width, header["height"] = image.height, header["scale"] = scale;
    return binary_message(header, payload);
}

}  // namespace mote::viewer
