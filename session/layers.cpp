#include "session/layers.h"

#include <algorithm>
#include <stdexcept>

#include "core/objects/error.h"

namespace mote::session {

namespace {

struct ChannelName {
    std::string layer, channel;
};

ChannelName split(const std::string& name) {
    if (name == "R" || name == "G" || name == "B") return {beauty_layer, name};
    if (name == "A") return {alpha_layer, name};
    const auto dot = name.rfind('.');
    return dot == std::string::npos ? ChannelName{name, ""}
                                    : ChannelName{name.substr(0, dot), name.substr(dot + 1)};
}

/// R before G before B; X, Y, Z as the alphabet has them.
int rank(const std::string& channel) {
    const auto at = std::string("RGBXYZ").find(channel);
    return channel.empty() || at == std::string::npos ? 6 : int(at);
}

void sort_channels(LayerChannels& layer) {
    std::vector<std::size_t> order(layer.channels.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return rank(layer.channels[a]) < rank(layer.channels[b]);
    });
    LayerChannels sorted{layer.name, {}, {}};
    for (const std::size_t i : order)
        sorted.channels.push_back(layer.channels[i]), sorted.planes.push_back(layer.planes[i]);
    layer = std::move(sorted);
}

bool holds_vectors(const std::string& layer) {
    const auto dot = layer.rfind('.');
    const std::string last = dot == std::string::npos ? layer : layer.substr(dot + 1);
    return last == "P" || last == "N" || last == "Ns" || last == "PreviousP" || last == "MotionVector";
}

/// The names of a layer's channels in a picture.
std::vector<std::string> channel_names(const std::string& layer, int channels) {
    if (channels == 1) return {layer == alpha_layer ? "A" : layer + (layer == "Depth" ? ".Z" : ".Y")};
    const std::string prefix = layer == beauty_layer ? "" : layer + ".";
    std::vector<std::string> names;
    for (const char c : std::string(holds_vectors(layer) ? "XYZ" : "RGB")) names.push_back(prefix + c);
    return names;
}

void remove_layer(core::ImageChannels& image, const std::string& name) {
    for (std::size_t k = image.names.size(); k-- > 0;) {
        if (split(image.names[k]).layer != name) continue;
        image.names.erase(image.names.begin() + std::ptrdiff_t(k));
        image.channels.erase(image.channels.begin() + std::ptrdiff_t(k));
    }
}

}  // namespace

std::vector<LayerChannels> layers_of(const core::ImageChannels& image) {
    std::vector<LayerChannels> layers;
    for (std::size_t plane = 0; plane < image.names.size(); ++plane) {
        const ChannelName name = split(image.names[plane]);
        auto at =
            std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.name == name.layer; });
        if (at == layers.end()) at = layers.insert(layers.end(), {name.layer, {}, {}});
        at->channels.push_back(name.channel), at->planes.push_back(plane);
    }
    for (LayerChannels& layer : layers) sort_channels(layer);
    return layers;
}

LayerChannels find_layer(const core::ImageChannels& image, const std::string& name) {
    std::vector<std::string> known;
    for (LayerChannels& layer : layers_of(image)) {
        if (layer.name == name) return std::move(layer);
        known.push_back(layer.name);
    }
    throw core::InputError("there is no layer '" + core::printable(name) + "'" +
                           core::suggestion(name, known));
}

void set_layer(core::ImageChannels& image, const std::string& name, int width, int height, int channels,
               std::span<const float> values) {
    if (channels != 1 && channels != 3)
        throw core::InputError("a layer has one channel or three, not " + std::to_string(channels));
    if (width < 1 || height < 1) throw core::InputError("a picture has at least one pixel");
    if (!image.names.empty() && (image.width != width || image.height != height))
        throw core::InputError("the layer '" + core::printable(name) + "' has " + std::to_string(width) +
                               " x " + std::to_string(height) + " pixels, the picture " +
                               std::to_string(image.width) + " x " + std::to_string(image.height));
    const std::size_t pixels = std::size_t(width) * std::size_t(height), n = std::size_t(channels);
    if (values.size() != pixels * n) throw std::invalid_argument("a buffer that does not fit its layer");
    remove_layer(image, name);
    image.width = width, image.height = height;
    const std::vector<std::string> names = channel_names(name, channels);
    for (std::size_t c = 0; c < n; ++c) {
        std::vector<float> plane(pixels);
        for (std::size_t p = 0; p < pixels; ++p) plane[p] = values[p * n + c];
        image.add(names[c], std::move(plane));
    }
}

void copy_layer(const core::ImageChannels& image, const LayerChannels& layer, std::span<float> values) {
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height), n = layer.planes.size();
    if (values.size() != pixels * n) throw std::invalid_argument("a buffer that does not fit its layer");
    for (std::size_t c = 0; c < n; ++c) {
        const std::vector<float>& plane = image.channels[layer.planes[c]];
        for (std::size_t p = 0; p < pixels; ++p) values[p * n + c] = plane[p];
    }
}

}  // namespace mote::session
