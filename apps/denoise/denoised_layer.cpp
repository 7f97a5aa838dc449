#include "apps/denoise/denoised_layer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/objects/error.h"

namespace mote::apps {

using core::ImageChannels, core::Rgb;

namespace {

/// Colours that are no part of the beauty (core/image/film_image.cpp, apps/auxiliary_channels.h).
bool is_auxiliary(const std::string& layer) {
    static const std::array<std::string, 4> names{"Albedo", "DiffuseAlbedo", "Transmittance", "Variance"};
    static const std::array<std::string, 3> beginnings{"Variance.", "Center.", "hidden_light_"};
    return std::find(names.begin(), names.end(), layer) != names.end() ||
           std::any_of(beginnings.begin(), beginnings.end(),
                       [&](const std::string& b) { return layer.starts_with(b); });
}

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

/// Apart from the rounding of every layer to float16.
bool add_up(const ImageChannels& image, const std::vector<std::string>& layers, std::span<const Rgb> beauty) {
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

/// Three planes as one vector a pixel, or nothing.
std::vector<Rgb> vectors(const ImageChannels& image, const std::string& layer) {
    const std::vector<float>*x = image.find(layer + ".X"), *y = image.find(layer + ".Y"),
          *z = image.find(layer + ".Z");
    if (!x || !y || !z) return {};
    std::vector<Rgb> result(x->size());
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = Rgb((*x)[i], (*y)[i], (*z)[i]);
    return result;
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

}  // namespace

void add_denoised_layer(ImageChannels& image, const OidnLibrary& library) {
    const std::vector<Rgb> beauty = image.rgb("");
    if (beauty.empty()) throw core::InputError("a picture without R, G and B cannot be denoised");
    if (!image.rgb(denoised_layer).empty()) throw core::InputError("it is denoised already");
    using Feature = OidnLibrary::Feature;
    const int width = image.width, height = image.height;
    const auto albedo = library.denoised_feature(Feature::albedo, width, height, image.rgb("Albedo")),
               normal = library.denoised_feature(Feature::normal, width, height, vectors(image, "Ns"));
    const auto denoised = [&](std::span<const Rgb> pixels) {
        return library.denoised({width, height, pixels, albedo, normal});
    };

    std::vector<Rgb> sum(beauty.size(), Rgb(0.0f));
    std::vector<std::string> layers = layers_of_beauty(image), done;
    if (add_up(image, layers, beauty)) {
        for (const std::string& layer : layers) {
            const std::vector<Rgb> pixels = image.rgb(layer);
            const bool keep = layer == "emission";
            const std::vector<Rgb> part = keep ? pixels : denoised(pixels);
            for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
            if (!keep) done.push_back(layer);
        }
    } else {
        sum = denoised(beauty), done = {"the beauty as a whole"};
    }
    image.add_rgb(denoised_layer, sum);
    image.metadata[denoised_layer] =
        "the layer '" + denoised_layer + "', by OpenImageDenoise " + library.version() + ": " + joined(done) +
        (albedo.empty() ? ", without features" : ", with Albedo") +
        (albedo.empty() || normal.empty() ? "" : " and Ns") + "; all other layers are as they were measured";
}

ImageChannels denoised_picture(const ImageChannels& image) {
    ImageChannels picture;
    picture.width = image.width, picture.height = image.height, picture.metadata = image.metadata;
    picture.add_rgb("", image.rgb(denoised_layer));
    return picture;
}

std::string denoised_doubt(const std::map<std::string, std::string>& metadata, const std::string& path,
                           const std::string& layer) {
    if (!metadata.contains(denoised_layer)) return "";
    const std::string name = core::printable(path, 300);
    if (layer == denoised_layer)
        return "the layer 'denoised' of " + name +
               " is a picture for the eye: what is measured here is the denoiser as well, not a method alone";
    return name + " also holds a denoised picture, which is not what is measured here";
}

}  // namespace mote::apps
