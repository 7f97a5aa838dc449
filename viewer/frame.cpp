#include "viewer/frame.h"

#include <half.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "session/denoise/beauty_layers.h"
#include "session/denoise/denoised_layer.h"
#include "session/layers.h"

namespace mote::viewer {

namespace {

const std::string deviation_layer = "standard deviation";

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
    constexpr float max_half = HALF_MAX;
    return half(std::clamp(value, -max_half, max_half)).bits();
}

std::vector<FrameLayer> frame_layers(const core::ImageChannels& image) {
    const std::vector<std::string> light = session::layers_of_beauty(image);
    std::vector<FrameLayer> layers;
    bool variance = false;
    for (const session::LayerChannels& layer : session::layers_of(image)) {
        if (layer.name == "Variance" && is_rgb(layer)) variance = true;
        if (!is_rgb(layer) || layer.name == "Variance") continue;
        const bool of_sum = std::ranges::find(light, layer.name) != light.end();
        layers.push_back({layer.name, of_sum && layer.name != session::denoised_layer});
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
