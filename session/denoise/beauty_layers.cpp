#include "session/denoise/beauty_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mote::session {

using core::ImageChannels, core::Rgb;

namespace {

/// Colours that are no part of the beauty (core/film/film_image.cpp, session/auxiliary_channels.h).
bool is_auxiliary(const std::string& layer) {
    static const std::array<std::string, 5> names{"Albedo", "DiffuseAlbedo", "Transmittance", "InScattered",
                                                  "Variance"};
    static const std::array<std::string, 4> beginnings{"Variance.", "Center.", "Mirrored.", "hidden_light_"};
    return std::find(names.begin(), names.end(), layer) != names.end() ||
           std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& b) { return layer.starts_with(b); });
}

}  // namespace

std::vector<std::string> layers_of_beauty(const ImageChannels& image) {
    std::vector<std::string> layers;
    for (const std::string& name : image.names) {
        if (!name.ends_with(".R")) continue;
        const std::string layer = name.substr(0, name.size() - 2);
        if (!is_auxiliary(layer) && image.find(layer + ".G") && image.find(layer + ".B"))
            layers.push_back(layer);
    }
    return layers;
}

bool layers_add_up(const ImageChannels& image, const std::vector<std::string>& layers,
                   std::span<const Rgb> beauty) {
    if (layers.empty()) return false;
    std::vector<Rgb> sum(beauty.size(), Rgb(0.0f)), size = sum;
    for (const std::string& layer : layers) {
        const std::vector<Rgb> pixels = image.rgb(layer);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += pixels[i], size[i] += glm::abs(pixels[i]);
    }
    constexpr float rounding = 1.0f / 1024.0f, smallest_half = 6e-8f;
    for (std::size_t i = 0; i < sum.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const float most = rounding * size[i][c] + smallest_half * float(layers.size() + 1);
            if (std::isfinite(beauty[i][c]) && !(std::fabs(sum[i][c] - beauty[i][c]) <= most)) return false;
        }
    return true;
}

std::vector<core::Vec3> vector_layer(const ImageChannels& image, const std::string& layer) {
    const std::vector<float>*x = image.find(layer + ".X"), *y = image.find(layer + ".Y"),
          *z = image.find(layer + ".Z");
    if (!x || !y || !z) return {};
    std::vector<core::Vec3> result(x->size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = core::Vec3((*x)[i], (*y)[i], (*z)[i]);
    return result;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace mote::session
