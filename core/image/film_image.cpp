// Names of channels: what is not part of the beauty must not look like it.
#include "core/image/film_image.h"

#include <algorithm>

namespace mote::core {

namespace {

void add_plane(ImageChannels& image, const std::string& name, const std::vector<Rgb>& pixels, int channel) {
    std::vector<float> plane(pixels.size());
    std::transform(pixels.begin(), pixels.end(), plane.begin(),
                   [channel](const Rgb& p) { return p[channel]; });
    image.add(name, std::move(plane));
}

void add_auxiliary(ImageChannels& image, const std::string& name, const std::vector<Rgb>& pixels) {
    if (name == "Depth") return add_plane(image, "Depth.Z", pixels, 0);
    if (name != "N" && name != "Ns" && name != "P") return image.add_rgb(name, pixels);
    const char* axes[3] = {".X", ".Y", ".Z"};
    for (int c = 0; c < 3; ++c) add_plane(image, name + axes[c], pixels, c);
}

}  // namespace

ImageChannels film_image(const Film& film) {
    ImageChannels image;
    image.width = film.width(), image.height = film.height();
    image.add_rgb("", film.beauty());
    for (std::size_t i = 0; i < film.layers().size(); ++i) {
        const Layer& layer = film.layers()[i];
        if (layer.auxiliary)
            add_auxiliary(image, layer.name, film.mean(i));
        else
            image.add_rgb(layer.name, film.mean(i));
    }
    if (film.pass_count() >= 2) image.add_rgb("Variance", film.beauty_variance_of_mean());
    return image;
}

}  // namespace mote::core
