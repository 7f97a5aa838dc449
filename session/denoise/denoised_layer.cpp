#include "session/denoise/denoised_layer.h"

#include "core/objects/error.h"
#include "session/denoise/beauty_layers.h"
#include "session/denoise/bmfr_sequence.h"

namespace mote::session {

using core::ImageChannels, core::Rgb;
using screenspace::OidnLibrary;

void add_denoised_layer(ImageChannels& image, const OidnLibrary& library) {
    const std::vector<Rgb> beauty = image.rgb("");
    if (beauty.empty()) throw core::InputError("a picture without R, G and B cannot be denoised");
    if (!image.rgb(denoised_layer).empty()) throw core::InputError("it is denoised already");
    using Feature = OidnLibrary::Feature;
    const int width = image.width, height = image.height;
    const auto albedo = library.denoised_feature(Feature::albedo, width, height, image.rgb("Albedo")),
               normal = library.denoised_feature(Feature::normal, width, height, vector_layer(image, "Ns"));
    const auto denoised = [&](std::span<const Rgb> pixels) {
        return library.denoised({width, height, pixels, albedo, normal});
    };

    std::vector<Rgb> sum(beauty.size(), Rgb(0.0f));
    std::vector<std::string> layers = layers_of_beauty(image), done;
    if (layers_add_up(image, layers, beauty)) {
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

Denoiser make_denoiser(const std::string& method, int threads, bool sequence, const std::string& package) {
    if (method == "oidn")
        return [library = std::make_shared<OidnLibrary>(threads, package)](ImageChannels& image) {
            add_denoised_layer(image, *library);
        };
    if (method == "bmfr")
        return [frames = std::make_shared<BmfrSequence>(!sequence)](ImageChannels& image) {
            frames->add_denoised_layer(image);
        };
    const std::vector<std::string> known = {"oidn", "bmfr"};
    throw core::InputError("there is no denoiser '" + core::printable(method) + "'" +
                           core::suggestion(method, known));
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

}  // namespace mote::session
