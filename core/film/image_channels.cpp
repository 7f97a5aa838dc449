// A picture as named planes of floats.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <stdexcept>

#include "core/film/image_channels.h"

namespace mote::core {

namespace {

std::string channel_name(const std::string& layer, const char* channel) {
    return layer.empty() ? channel : layer + "." + channel;
}

}  // namespace

void ImageChannels::add(const std::string& name, std::vector<float> plane) {
    if (width < 1 || height < 1 || plane.size() != std::size_t(width) * std::size_t(height))
        throw std::invalid_argument("the plane '" + name + "' does not fit the picture");
    if (find(name)) throw std::invalid_argument("the picture has a channel '" + name + "' already");
    names.push_back(name);
    channels.push_back(std::move(plane));
}

void ImageChannels::add_rgb(const std::string& layer, std::span<const Rgb> pixels) {
    const char* channel[3] = {"R", "G", "B"};
    std::vector<float> planes[3];
    tbb::parallel_for(0, 3, [&](int c) {
        planes[c].resize(pixels.size());
        std::transform(pixels.begin(), pixels.end(), planes[c].begin(), [c](const Rgb& p) { return p[c]; });
    });
    for (int c = 0; c < 3; ++c) add(channel_name(layer, channel[c]), std::move(planes[c]));
}

const std::vector<float>* ImageChannels::find(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nullptr : &channels[std::size_t(found - names.begin())];
}

std::vector<Rgb> ImageChannels::rgb(const std::string& layer) const {
    const std::vector<float>* plane[3] = {find(channel_name(layer, "R")), find(channel_name(layer, "G")),
                                          find(channel_name(layer, "B"))};
    if (!plane[0] || !plane[1] || !plane[2]) return {};
    std::vector<Rgb> pixels(plane[0]->size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = {(*plane[0])[i], (*plane[1])[i], (*plane[2])[i]};
    return pixels;
}

}  // namespace mote::core
