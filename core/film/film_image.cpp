// Names of channels: what is not part of the beauty must not look like it.
#include "core/film/film_image.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace mote::core {

namespace {

void add_plane(ImageChannels& image, const std::string& name, const std::vector<Rgb>& pixels, int channel) {
    std::vector<float> plane(pixels.size());
    std::transform(pixels.begin(), pixels.end(), plane.begin(),
                   [channel](const Rgb& p) { return p[channel]; });
    image.add(name, std::move(plane));
}

/// Scalars are one plane, vectors of the world have axes, all others are colours.
void add_auxiliary(ImageChannels& image, const std::string& name, const std::string& kind,
                   const std::vector<Rgb>& pixels) {
    if (kind == "Depth") return add_plane(image, name + ".Z", pixels, 0);
    if (kind == "Coverage") return add_plane(image, name + ".Y", pixels, 0);
    const bool vector = kind == "N" || kind == "Ns" || kind == "P" || kind == "PreviousP" ||
                        kind.ends_with(".P") || kind.ends_with(".Ns");
    const bool flat = kind == "MotionVector";  // within the picture
    if (!vector && !flat) return image.add_rgb(name, pixels);
    const char* axes[3] = {".X", ".Y", ".Z"};
    for (int c = 0; c < (flat ? 2 : 3); ++c) add_plane(image, name + axes[c], pixels, c);
}

void add_auxiliary(ImageChannels& image, const Film& film, std::size_t i) {
    const std::string& name = film.layers()[i].name;
    std::vector<Rgb> mean = film.mean(i);
    // Nothing was hit, so it is as far away as can be.
    if (name == "Depth") std::replace(mean.begin(), mean.end(), Rgb(0.0f), Rgb(infinity));
    add_auxiliary(image, name, name, mean);
    if (film.has_squares(i) && film.pass_count(film.layers()[i].part) >= 2)
        add_auxiliary(image, "Variance." + name, name, film.layer_variance_of_mean(i));
}

}  // namespace

ImageChannels film_image(const Film& film) {
    ImageChannels image;
    image.width = film.width(), image.height = film.height();
    std::vector<std::vector<Rgb>> means(film.layers().size());
    std::vector<Rgb> beauty(film.pixels(), Rgb(0.0f));  // Film::beauty(), whose layers are needed alone, too
    for (std::size_t i = 0; i < means.size(); ++i) {
        if (film.layers()[i].auxiliary) continue;
        means[i] = film.mean(i);
        tbb::parallel_for(std::size_t(0), beauty.size(), [&](std::size_t p) { beauty[p] += means[i][p]; });
    }
    image.add_rgb("", beauty);
    for (std::size_t i = 0; i < means.size(); ++i) {
        if (film.layers()[i].auxiliary)
            add_auxiliary(image, film, i);
        else
            image.add_rgb(film.layers()[i].name, means[i]);
        means[i] = {};
    }
    // A part with a single pass has a variance that is not known, and not one of zero.
    if (film.has_passes(2)) image.add_rgb("Variance", film.beauty_variance_of_mean());
    return image;
}

std::uint64_t infinite_variances(const ImageChannels& image) {
    const std::vector<Rgb> variance = image.rgb("Variance");
    return std::uint64_t(
        std::count_if(variance.begin(), variance.end(), [](const Rgb& v) { return !is_finite(v); }));
}

}  // namespace mote::core
